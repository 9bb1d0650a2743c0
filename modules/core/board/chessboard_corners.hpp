#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"

namespace voqcal {

/// The chessboard's inner corners in one grey image, to sub-pixel accuracy, in the order of
/// BoardSpec::InnerCornersBoardM; nothing if there is no chessboard of that size.
///
/// Of the turns that the pattern cannot tell apart, the one whose board y axis points up in the
/// image (or, if y is horizontal, whose x axis does). The same whatever cv::setNumThreads says.
///
/// @param grey  8-bit, 1 channel, not empty.
std::optional<std::vector<Eigen::Vector2d>> FindChessboardCorners(const cv::Mat& grey,
                                                                  const BoardSpec& board);

}  // namespace voqcal
