#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/sampling/sample_picker.hpp"
#include "core/sensor_network/common_boards.hpp"
#include "result/result_file.hpp"
#include "result/rig_extrinsics.hpp"

namespace voqcal {

/// A lidar and a camera of a rig, and what there is of their own session.
struct PairSession {
  std::string lidar;
  std::string camera;
  CameraModel lens;
  SamplePickerOptions sampling;
  bool use_log_times = false;  ///< For the boards' times: clocks are judged by pair.
  CalibratedPair pair;
  std::vector<SeenBoard> boards;  ///< That its result was made from; without one, all.
};

/// Fills `pair` and `boards`.
/// @param problem  why there is no `result`.
void TakeResult(const std::vector<BoardSample>& samples,
                const std::optional<CalibrationResult>& result,
                const std::string& problem,
                PairSession* session);

/// What a rig's result says of where it is from.
struct RigMadeFrom {
  std::string rig;
  std::string rig_sha256;
  std::string version;
};

/// The pairs, behind them the pairs of cameras whose sessions have at least three boards in common,
/// and the tree that all are joined to. Sensors stand in the order of the sessions.
/// @param reference  the sensor that the tree hangs from; empty: the first lidar.
RigExtrinsics JoinSessions(const std::vector<PairSession>& sessions,
                           const std::string& reference,
                           const RigMadeFrom& made_from);

/// Of the pairs of a lidar and a camera that were calibrated, how well each is known in the tree.
struct PairInTree {
  std::string name;
  double sigma_rad = 0.0;  ///< 1 sigma of its turn and of its shift, all axes together.
  double sigma_m = 0.0;
};

/// In the order of the pairs; none without a tree.
std::vector<PairInTree> PairsInTree(const RigExtrinsics& result);

}  // namespace voqcal
