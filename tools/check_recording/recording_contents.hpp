#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "messaging/log.hpp"

namespace voqcal {

/// One channel of a recording.
struct ChannelContents {
  enum class Kind { kOther, kImages, kSweeps };

  Kind kind = Kind::kOther;  ///< By the fingerprints of image_t and pointcloud2_t.
  std::int64_t num_messages = 0;
  std::int64_t first_utime = 0;  ///< When it was received, microseconds since the Unix epoch.
  std::int64_t last_utime = 0;
  /// Of images and sweeps, by gaps in their sequence numbers (NumLostBetween).
  std::int64_t num_lost = 0;
  std::optional<std::int64_t> first_loss_utime{};  ///< Of what came next.
  /// Two images or sweeps have different numbers: without, losses do not show.
  bool is_numbered = false;
  std::int64_t num_unreadable = 0;  ///< Images or sweeps by their fingerprint, but broken.
  std::optional<std::int64_t> last_sequence{};

  /// Messages per second; nothing for fewer than two.
  std::optional<double> RateHz() const;
};

/// What a recording holds, and what it lacks of what the sensors sent.
struct RecordingContents {
  std::map<std::string, ChannelContents> channels;
  std::int64_t begin_utime = 0;  ///< Of the first message.
  std::int64_t end_utime = 0;    ///< Of the last one.
  std::int64_t num_bytes = 0;
  std::int64_t num_damaged = 0;    ///< Places between whole events.
  std::int64_t num_cut_bytes = 0;  ///< Of events that are not whole, at the logs' ends.

  void Take(const LogEvent& event);
  std::int64_t NumLost() const;
  /// "CAMERA_IMAGE: 1 of 306 lost, the first 9.0 s after the start; ...": empty if nothing is.
  std::string Missing() const;
  /// "CAMERA_IMAGE is not numbered; no sweeps": why it cannot be told whether all is there; empty
  /// if it can.
  std::string Unknown() const;
};

/// @param logs  one recording, in its order: a recorder that was started again begins another file.
/// @param on_progress  hears how much of all logs is read, 0 to 1.
/// @throws std::runtime_error naming the log, if it cannot be read or is no LCM log.
RecordingContents ContentsOf(const std::vector<std::filesystem::path>& logs,
                             const std::function<void(double share)>& on_progress = {});

}  // namespace voqcal
