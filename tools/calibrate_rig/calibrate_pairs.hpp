#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate/recording_clocks.hpp"
#include "result/join_rig.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Where the pairs' sessions are made, and where they go: each in a folder LIDAR_CAMERA of its own.
struct RigFolders {
  std::filesystem::path scratch;
  std::filesystem::path out;
};

/// What the pairs are calibrated from.
struct RigRecording {
  std::filesystem::path log;
  RecordingTimes times = RecordingTimes::kAuto;
  std::string given;  ///< As it was given, for people: the log may be an import of it.
};

/// "front_left".
std::string FolderOf(const Rig& pair);

struct CalibratedPairs {
  std::vector<PairSession> sessions;
  std::vector<std::string> advice;  ///< Of each pair without a result, FailureAdvice; else empty.
};

/// Does with each pair of a rig what calibrate does, but detects the boards of each sensor once for
/// all its pairs. Each pair's session is that of calibrate, byte for byte.
///
/// @throws std::runtime_error naming the log and the cause. That a pair gives no calibration is not
///     thrown but told, and its `problem`.
CalibratedPairs CalibratePairs(const std::vector<Rig>& pairs,
                               const RigRecording& recording,
                               const RigFolders& folders);

}  // namespace voqcal
