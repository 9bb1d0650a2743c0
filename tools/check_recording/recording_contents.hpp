#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "messaging/log.hpp"

namespace voqcal {

/// One channel of a recording.
struct ChannelContents {
  std::int64_t num_messages = 0;
  std::int64_t first_utime = 0;  ///< When it was received, microseconds since the Unix epoch.
  std::int64_t last_utime = 0;
  /// Of image_t and pointcloud2_t, by gaps in their sequence numbers; a number that is not above
  /// the last one is a sender that started anew.
  std::int64_t num_lost = 0;
  std::optional<std::int64_t> first_loss_utime{};  ///< Of what came next.
  std::int64_t num_unreadable = 0;                 ///< Of these types, by their own fingerprint.
  std::optional<std::int64_t> last_sequence{};

  /// Messages per second; nothing for fewer than two.
  std::optional<double> RateHz() const;
};

/// What an LCM log holds, and what it lacks of what the sensors sent.
struct RecordingContents {
  std::map<std::string, ChannelContents> channels;
  std::int64_t begin_utime = 0;  ///< Of the first message.
  std::int64_t end_utime = 0;    ///< Of the last one.
  std::int64_t num_bytes = 0;
  std::int64_t num_damaged = 0;    ///< Places between whole events.
  std::int64_t num_cut_bytes = 0;  ///< At the end, of an event that is not whole.

  void Take(const LogEvent& event);
  /// "CAMERA_IMAGE: 1 of 306 lost, the first 9.0 s after the start; ...": empty if nothing is.
  std::string Missing() const;
};

/// @throws std::runtime_error naming the log, if it cannot be read or is no LCM log.
RecordingContents ContentsOf(const std::filesystem::path& log);

}  // namespace voqcal
