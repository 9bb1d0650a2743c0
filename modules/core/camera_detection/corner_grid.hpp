#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

#include "core/camera_detection/x_corners.hpp"

namespace voqcal {

/// Corners in a grid, row by row; NaN where one is missing.
struct CornerGrid {
  cv::Size size;
  std::vector<cv::Point2f> corners;
  int num_found = 0;
};

/// Links X-corners along their edges to grids: neighbours lie in the direction of each other's
/// edges with dark and bright swapped, and each is the other's nearest such corner.
///
/// @return the largest grid that is `pattern` or a part of it, `pattern.width` corners to a row at
///     most, in one of the orders that the grid allows (turned, mirrored). A larger grid is another
///     board. Complete if num_found is the pattern's area; num_found is 0 if there is none.
CornerGrid FindCornerGrid(const std::vector<XCorner>& corners, const cv::Size& pattern);

}  // namespace voqcal
