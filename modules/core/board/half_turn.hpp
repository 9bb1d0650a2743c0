#pragma once

#include <functional>

#include "core/board/board_sample.hpp"

namespace voqcal {

/// The outline's two lengths differ by less than a twentieth: nothing but what is printed on it
/// tells such a plate's quarter-turns apart.
bool IsSquare(double width_m, double height_m);

/// The same outline, its axes turned by so many quarters about its normal (corner i becomes corner
/// i + num_quarters): by halves for any board, by quarters for a square one.
BoardPose TurnedByQuarters(const BoardPose& pose, int num_quarters);

/// Of the turns after which the outline is the same (two, of a square plate four), in quarters, the
/// one of least `cost`; of equals the first.
int BestTurn(const BoardPose& pose, const std::function<double(const BoardPose&)>& cost);

/// The sample's lidar pose with its corners in the camera's order. The board looks the same after
/// half a turn, a square plate after a quarter, so the two sensors may start at other corners: of
/// these ways, the one is taken whose corners lie nearest to the camera's under `T_camera_lidar`.
BoardPose LidarPoseInCameraOrder(const BoardSample& sample,
                                 const Eigen::Isometry3d& T_camera_lidar);

}  // namespace voqcal
