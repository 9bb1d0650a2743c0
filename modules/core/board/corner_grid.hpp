#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

#include "core/board/x_corners.hpp"

namespace voqcal {

/// Links X-corners along their edges to grids: neighbours lie in the direction of each other's
/// edges with dark and bright swapped, and each is the other's nearest such corner.
///
/// @return `pattern.width` corners to a row, `pattern.height` rows, in one of the orders that the
///     grid allows (turned, mirrored); empty if no complete grid of exactly that size was found: a
///     larger one is another board.
std::vector<cv::Point2f> FindCornerGrid(const std::vector<XCorner>& corners,
                                        const cv::Size& pattern);

}  // namespace voqcal
