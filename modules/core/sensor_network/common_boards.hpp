#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/sensor_network/sensor_pair.hpp"

namespace voqcal {

/// One pose of the board, as two cameras of a rig saw it, each in its own frame.
struct CommonBoard {
  BoardPose from;
  BoardPose to;
};

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
