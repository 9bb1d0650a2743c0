#pragma once

#include <array>
#include <vector>

#include <opencv2/core/types.hpp>

#include "core/camera_detection/x_corners.hpp"

namespace voqcal {

/// No corner.
inline constexpr int kNoCorner = -1;

/// The four ways to leave a corner: along axes[0], axes[1], and against them.
inline constexpr int kNumWays = 4;
inline cv::Point2f Direction(const XCorner& corner, int way) {
  const cv::Point2f& axis = corner.axes[way % 2];
  return way < 2 ? axis : -axis;
}

/// The index of each corner's neighbour each way, or kNoCorner.
using CornerLinks = std::vector<std::array<int, kNumWays>>;

/// Whether `to`, a `step` away by `way`, may be the next corner of a chessboard: neighbours swap
/// dark and bright, so the edge that joins them is axes[0] of one and axes[1] of the other.
bool MayJoin(const XCorner& from, const XCorner& to, int way, const cv::Point2f& step);

/// Each corner's nearest possible neighbours, where they are so mutually and no leap.
CornerLinks LinkCorners(const std::vector<XCorner>& corners);

}  // namespace voqcal
