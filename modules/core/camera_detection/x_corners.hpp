#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

namespace voqcal {

/// A point where two straight edges cross, with dark and bright quarters in turn: what a chessboard
/// looks like at an inner corner.
struct XCorner {
  cv::Point2f position_px;
  /// Directions of the two edges, unit length. The quarter swept from axes[0] to axes[1], from
  /// pixel x towards pixel y, is a bright one (and so is the opposite quarter).
  std::array<cv::Point2f, 2> axes;
  float contrast = 0.0F;  ///< Brightest minus darkest grey level on a circle around it.
};

/// The X-corners of a grey image whose squares are at least about 5 px wide, to about 0.2 px: those
/// of most contrast, up to `max_corners` of them, most first. The same whatever cv::setNumThreads
/// says.
///
/// @param grey  8-bit, 1 channel.
std::vector<XCorner> FindXCorners(const cv::Mat& grey, std::size_t max_corners);

}  // namespace voqcal
