#pragma once

#include <array>
#include <vector>

#include <opencv2/core/types.hpp>

#include "core/camera_detection/x_corners.hpp"

namespace voqcal {

/// Four X-corners, from pixel x towards pixel y.
using Square = std::array<cv::Point2f, 4>;

/// The four-sided areas that edges from X-corner to X-corner bound, dark along the edges: what lies
/// farther inside does not matter.
std::vector<Square> DarkSquares(const std::vector<XCorner>& corners);

}  // namespace voqcal
