#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// How well an image shows a board whose pose is known.
struct CameraBoardView {
  /// Of the edges between squares, from 10 % to 90 % of the step if the blur is Gaussian: the
  /// median of the edges along x or along y, whichever is wider (motion blurs one more).
  double edge_width_px = 0.0;
  double square_px = 0.0;  ///< The shortest distance of two neighbouring corners.
  /// Contrast (bright - dark) / (bright + dark) around the palest corner, as share of the corners'
  /// median. Shade takes away from bright and dark alike and leaves it at 1; glare adds to both.
  double least_contrast = 0.0;
  double outside_share = 0.0;  ///< Share of the board's outline that lies outside the image.
};

/// @param grey        8-bit, 1 channel, of the camera's size.
/// @param corners_px  inner corners in BoardSpec::InnerCornersBoardM's order; NaN: not seen.
CameraBoardView MeasureView(const cv::Mat& grey,
                            const CameraModel& camera,
                            const BoardSpec& board,
                            const Eigen::Isometry3d& T_camera_board,
                            const std::vector<Eigen::Vector2d>& corners_px);

}  // namespace voqcal
