#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera_detection/camera_board_fault.hpp"
#include "core/expected.hpp"

namespace voqcal {

/// The inner corners of a ChArUco board in one grey image, to sub-pixel accuracy, in the order of
/// BoardSpec::InnerCornersBoardM; NaN for those not seen. Markers say which corner is which, so a
/// part of the board is enough, and it has no half-turn that looks the same.
///
/// @param grey  8-bit, 1 channel, not empty.
/// @return at least 6 corners, not all on a line, or why there are none.
Expected<std::vector<Eigen::Vector2d>, CameraBoardMiss> FindCharucoCorners(const cv::Mat& grey,
                                                                           const BoardSpec& board);

/// The pattern as OpenCV 4.6 prints it, board y up, without margin: 8-bit, 1 channel. Seen so, the
/// top left square is black, and marker 0 lies in the white one beside it.
cv::Mat DrawCharuco(const BoardSpec& board, int pixels_per_square);

}  // namespace voqcal
