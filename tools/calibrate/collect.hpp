#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "calibrate/offline_run.hpp"

namespace voqcal {

/// Where calibrate and evaluate get their samples: a recording (or a session's samples.lcm), or a
/// table of extracted features. Exactly one is given.
struct InputPaths {
  std::optional<std::filesystem::path> log;
  std::optional<std::filesystem::path> poses;
  RecordingTimes times = RecordingTimes::kAuto;  ///< Of a recording.

  const std::filesystem::path& Given() const { return log ? *log : *poses; }
};

/// A run on `session_folder` that has collected every sample of the input, with progress on the
/// terminal.
/// @throws std::runtime_error naming the file and the cause.
std::unique_ptr<OfflineRun> CollectSamples(const Rig& rig,
                                           const InputPaths& input,
                                           const std::filesystem::path& session_folder);

/// "lidar_board_detector: 30 boards; sample_collector: 28 accepted, 2 board is moving".
std::string CountsOf(const OfflineRun& run);

/// The same as a line of an error, with its line break before it; empty if nothing was counted.
std::string CountsLine(const OfflineRun& run);

}  // namespace voqcal
