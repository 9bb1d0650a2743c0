#pragma once

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"

namespace voqcal {

/// The sample's lidar pose with its corners in the camera's order. The board looks the same after
/// half a turn, so the two sensors may start at opposite corners: of the two ways, the one is taken
/// whose corners lie nearer to the camera's under `T_camera_lidar`.
BoardPose LidarPoseInCameraOrder(const BoardSample& sample,
                                 const Eigen::Isometry3d& T_camera_lidar);

}  // namespace voqcal
