#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "messaging/log.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// A message's own time, and when it was recorded; microseconds.
struct RecordedTime {
  std::int64_t utime = 0;
  std::int64_t log_utime = 0;
};

/// What is taken for the time of a recording's messages.
enum class RecordingTimes {
  kAuto,  ///< Their stamps, unless these are of different clocks and the log times agree.
  kStamps,
  kLog,  ///< When they were recorded.
};

/// Whether log times are needed.
struct ClockVerdict {
  bool use_log_times = false;
  std::string words;  ///< One line for people; empty: nothing to say.
};

/// Whether stamps of lidar and camera are of one clock. Only clocks so far apart that no sweep
/// could meet an image count: what drivers differ by at their start is not looked at.
ClockVerdict JudgeClocks(const std::vector<RecordedTime>& lidar,
                         const std::vector<RecordedTime>& camera);

/// The same of the first messages of a recording.
ClockVerdict JudgeClocksOf(const std::filesystem::path& log, const Channels& channels);

/// Gives a sweep or an image the time at which it was recorded: both begin with their utime.
void TakeLogTime(LogEvent* event);

}  // namespace voqcal
