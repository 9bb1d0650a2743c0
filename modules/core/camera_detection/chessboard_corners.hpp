#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera_detection/corner_grid.hpp"
#include "core/expected.hpp"

namespace voqcal {

/// The chessboard's inner corners in one grey image, to sub-pixel accuracy, in the order of
/// BoardSpec::InnerCornersBoardM; if there is no whole chessboard of that size, the largest part of
/// one, to about a pixel.
///
/// Where the numbers of corners have an odd sum, the square at (-x, -y) is a dark one. Else the
/// pattern looks the same after half a turn: of the two, the one whose board y axis points up in
/// the image (or, if y is horizontal, whose x axis does). The same whatever cv::setNumThreads says.
///
/// @param grey  8-bit, 1 channel, not empty.
Expected<std::vector<Eigen::Vector2d>, CornerGrid> FindChessboardCorners(const cv::Mat& grey,
                                                                         const BoardSpec& board);

}  // namespace voqcal
