#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/scene/points_in_sight.hpp"

namespace voqcal {

/// Where one looks from, as a camera without distortion: x right, y down, z forward.
struct ObliqueView {
  Eigen::Isometry3d T_view_lidar;
  double focal_px;
  double nearest_m;  ///< What is nearer than this hides the board: it is left out.
};

/// The board from as far as the camera is, but 35 degrees beside it and 20 above, on the side that
/// sees more of the board's face; as large whatever its distance. Nearest is half of the distance.
ObliqueView ObliqueViewOf(const BoardPose& board_lidar_m, const Eigen::Isometry3d& T_camera_lidar);

/// The points as patches that touch where they show a surface, as the view has them: 720 x 450 px,
/// its z axis a little below the middle.
cv::Mat DrawObliqueView(const std::vector<ColouredPoint>& points, const ObliqueView& view);

}  // namespace voqcal
