#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace voqcal {

/// Where to look for an X-corner, and what its two edges are about.
struct XCornerGuess {
  Eigen::Vector2d position_px;
  /// To the ends of the area that is fitted, from its middle along the two edges: beyond them other
  /// edges may lie.
  Eigen::Vector2d reach_x_px;
  Eigen::Vector2d reach_y_px;
};

/// An X-corner to about 0.01 px, by least squares over the pixels around it: two blurred edges that
/// cross. cv::cornerSubPix is off by up to 0.1 px where an image is sharp, as its gradients are
/// those of a surface between pixels. Nothing if the pixels do not look so, or if the corner lies
/// farther away than a third of the reach or 1 px.
///
/// @param grey  8-bit, 1 channel.
std::optional<Eigen::Vector2d> FitXCorner(const cv::Mat& grey, const XCornerGuess& guess);

}  // namespace voqcal
