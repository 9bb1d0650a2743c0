#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera_detection/camera_board_fault.hpp"
#include "core/expected.hpp"

namespace voqcal {

/// A corner where two dark quarters meet across, to sub-pixel accuracy; nothing if it is not near
/// `near_px`, or its four quarters do not differ.
///
/// @param step_x_px, step_y_px  the sides of the square or tag at that corner.
/// @param rim_squares           as far as this share of them the quarters are of one shade.
std::optional<Eigen::Vector2d> RefinedCorner(const cv::Mat& grey,
                                             const cv::Point2f& near_px,
                                             const cv::Point2f& step_x_px,
                                             const cv::Point2f& step_y_px,
                                             double rim_squares);

/// The corners if they fix a pose: at least 6, not all on a line.
///
/// @param corners_px  in BoardSpec::InnerCornersBoardM's order; NaN: not seen.
Expected<std::vector<Eigen::Vector2d>, CameraBoardMiss> EnoughCorners(
    const std::vector<Eigen::Vector2d>& corners_px,
    std::size_t num_markers,
    const BoardSpec& board);

}  // namespace voqcal
