#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "files/sha256.hpp"
#include "messaging/log.hpp"
#include "messaging/session_scenes.hpp"
#include "sample_collector/frame_buffer.hpp"

namespace voqcal {

/// What both sensors saw at a sample's first frame; null where a frame was lost. Borrowed.
struct SampleScene {
  const SensorFrame* sweep = nullptr;  ///< An encoded pointcloud2_t.
  const SensorFrame* image = nullptr;  ///< An encoded image_t.

  bool IsWhole() const { return sweep != nullptr && image != nullptr; }
};

/// The accepted samples of one session, kept as an append-only LCM log: samples.lcm in the
/// session's folder. Every change is on the disk before the call returns, and the log opened again
/// gives the same samples.
///
/// Events: CALIB_SAMPLE (sample_t) for an accepted sample, after its scene if there is one
/// (messaging/session_scenes.hpp), CALIB_EVENT (event_t) for "discarded" and "reset". Event times
/// are sensor times, so the same samples make the same bytes.
class SessionLog {
 public:
  /// @param folder  made if missing; an existing samples.lcm goes on.
  /// @throws std::runtime_error if the folder or the log cannot be made, read or locked.
  explicit SessionLog(const std::filesystem::path& folder);

  /// Adds the sample under the next free id (1, 2, ...), or its own if that is larger (the number
  /// of a pose in a table). The scene is kept if it is whole. @return its id.
  std::int64_t Accept(BoardSample sample, const SampleScene& scene = {});

  /// Takes a sample away; 0 means the newest. @return its id; nothing if there is no such sample.
  std::optional<std::int64_t> Discard(std::int64_t id);

  /// Takes all samples away.
  void Reset();

  const std::vector<BoardSample>& samples() const { return samples_; }
  /// How many changes there were: a new number for each set of samples of this session.
  std::int64_t revision() const { return revision_; }
  /// SHA-256 of the log's bytes, lower-case hex.
  std::string Sha256() const { return file_hash_.Hex(); }

 private:
  /// One change of the samples: its CALIB_SAMPLE or CALIB_EVENT, after the scene if there is one.
  using Change = std::vector<LogEvent>;

  LogEvent Event(const char* channel, std::int64_t utime, std::vector<std::uint8_t> bytes) const;
  void ReadAgain();
  void Append(const Change& change);
  void Apply(const Change& change);

  std::filesystem::path path_;
  LogWriter writer_;
  voqcal::Sha256 file_hash_;
  std::vector<BoardSample> samples_;
  std::int64_t revision_ = 0;
  std::int64_t next_id_ = 1;
};

}  // namespace voqcal
