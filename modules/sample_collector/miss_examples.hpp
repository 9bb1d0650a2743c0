#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "messaging/log.hpp"
#include "messaging/module.hpp"
#include "sample_collector/frame_buffer.hpp"

namespace voqcal {

/// Of the frames that showed no board a few of each reason: where a session comes to nothing, they
/// tell why (messaging/session_misses.hpp).
class MissExamples {
 public:
  /// @param frame_channel  of the frame and...
  /// @param board_channel  ...of what the detector said of it, in misses.lcm.
  /// @param reason         as the detector said it; its numbers make no other reason.
  /// @param frame          null if it is not at hand (any more): then it only counts.
  /// @param board          the detector's message.
  void Note(const std::string& frame_channel,
            const std::string& board_channel,
            const std::string& reason,
            const SensorFrame* frame,
            const std::vector<std::uint8_t>& board);
  void Clear();

  /// Writes misses.lcm, in place of an earlier one.
  /// @param collector  whose counters go with it.
  /// @throws std::runtime_error naming the file and the cause.
  void Save(const std::filesystem::path& session_folder, const Module& collector) const;

 private:
  using Example = std::vector<LogEvent>;  ///< The frame, and what was said of it.

  struct Kept {
    std::int64_t num_times = 0;
    std::deque<Example> examples;
  };

  std::map<std::string, Kept> of_reason_;  ///< By board channel, ": " and reason.
  std::size_t num_bytes_ = 0;
};

}  // namespace voqcal
