#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/sensor_network/sensor_pair.hpp"

namespace voqcal {

/// A pose of the board at rest, as one camera saw it.
struct SeenBoard {
  std::int64_t camera_utime = 0;
  BoardPose pose;
};

/// One pose of the board, as two cameras of a rig saw it, each in its own frame.
struct CommonBoard {
  BoardPose from;
  BoardPose to;
};

/// When two cameras saw one pose, and when that is another than those before: as of samples.
struct CommonBoardLimits {
  double max_apart_s = 0.0;
  double min_new_distance_m = 0.0;
  double min_new_angle_rad = 0.0;
};

/// Adds the poses that both saw at one time, but for those that `boards` has: these would count
/// twice.
void AddCommonBoards(const std::vector<SeenBoard>& from,
                     const std::vector<SeenBoard>& to,
                     const CommonBoardLimits& limits,
                     std::vector<CommonBoard>* boards);

/// How two cameras stand to each other, by the boards that both saw: FitWithErrors, as of a lidar
/// and a camera, with a camera's errors. No lidar has a part in it, so it is much sharper than what
/// two of its pairs say.
/// @param to_camera  the lens of `to`.
/// @return nothing if the boards are fewer than three, or leave it open.
std::optional<SensorPair> PairOfCameras(const std::string& from,
                                        const std::string& to,
                                        const std::vector<CommonBoard>& boards,
                                        const CameraModel& to_camera);

}  // namespace voqcal
