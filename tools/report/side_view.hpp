#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/scene/points_in_sight.hpp"

namespace voqcal {

/// A view of the board from as far as the camera is, but 35 degrees beside it and 20 above: on the
/// side that sees more of the board's face.
Eigen::Isometry3d SideViewFromLidar(const BoardPose& board_lidar_m,
                                    const Eigen::Isometry3d& T_camera_lidar);

/// The points as that view has them, as patches that touch where they show a surface; 720 x 450 px.
cv::Mat DrawSideView(const std::vector<ColouredPoint>& points,
                     const Eigen::Isometry3d& T_view_lidar);

}  // namespace voqcal
