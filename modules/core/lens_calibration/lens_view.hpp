#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera_detection/camera_board_fault.hpp"
#include "core/expected.hpp"

namespace voqcal {

/// The board in one image, by a camera of which nothing is known.
struct LensView {
  std::int64_t utime = 0;  ///< Of the image, microseconds; equal times tell nothing.
  /// In BoardSpec::InnerCornersBoardM's order; NaN: not seen.
  std::vector<Eigen::Vector2d> corners_px;
  double edge_width_px = 0.0;  ///< As CameraBoardView has it; NaN: not known.
};

/// How many corners were seen.
std::size_t NumCorners(const LensView& view);

/// Finds the board's corners. Of a board with markers a part is enough: a third, and 8 corners.
/// @param grey  8-bit, 1 channel.
Expected<LensView, CameraBoardMiss> SeeLensView(const cv::Mat& grey,
                                                const BoardSpec& board,
                                                std::int64_t utime);

/// Which views tell the most of a lens.
struct ViewChoiceOptions {
  /// Two images tell whether the board moved if they are no further apart.
  double max_neighbour_s = 0.5;
  double max_still_motion_px = 1.0;  ///< Median of the corners, between two neighbours.
  /// Corners of two poses differ by this share of the image's diagonal, root mean square.
  double min_new_motion = 0.01;
  /// Blurred: edges so many times as wide as in the median image, and wider than 3 px.
  double max_edge_width_ratio = 2.0;
  std::size_t max_views = 80;  ///< More tell little more, and take long.
};

/// Views taken of a recording, and how many were left out why.
struct ViewChoice {
  std::vector<LensView> views;  ///< In the order of their times.
  std::size_t num_moving = 0;
  std::size_t num_blurred = 0;
  std::size_t num_repeated = 0;  ///< As one that was taken.
  std::size_t num_beyond = 0;    ///< More than max_views, the least different.
};

/// Views of different poses of a board at rest: beginning with the first, always the one that
/// differs most from all taken before. Where no neighbour in time tells, as in a series of stills,
/// a board counts as resting.
/// @param views  in the order of their times.
ViewChoice ChooseViews(const std::vector<LensView>& views,
                       const BoardSpec& board,
                       const cv::Size& image_px,
                       const ViewChoiceOptions& options);

}  // namespace voqcal
