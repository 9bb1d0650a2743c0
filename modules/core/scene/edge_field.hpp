#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/scene/scene_view.hpp"

namespace voqcal {

/// How surprising it is to see a depth edge at a pixel: -log of the rank (0 to 1) of the image's
/// gradient there, blurred. Where edges have nothing to do with each other ranks are uniform, and
/// its mean is 1; so it is 1 where the image says nothing: outside and on the board.
class EdgeField {
 public:
  static constexpr double kNothingSeen = 1.0;

  EdgeField() = default;  ///< Of no image: nothing is seen anywhere.

  /// @param blur_px  1 sigma, of the reduced image.
  EdgeField(const SceneView& view, double blur_px);

  /// The surprise at a pixel of the whole image, and its derivative unless `J_px` is null.
  double At(const Eigen::Vector2d& pixel_px, Eigen::RowVector2d* J_px) const;

 private:
  cv::Mat surprise_;  // CV_32F, of the reduced image
  double reduction_ = 1.0;
};

}  // namespace voqcal
