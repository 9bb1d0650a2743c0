#include "core/camera_detection/charuco_corners.hpp"

#include <limits>
#include <string>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/camera_detection/charuco_opencv.hpp"
#include "core/camera_detection/marker_corners.hpp"
#include "core/camera_detection/marker_dictionary.hpp"

namespace voqcal {
namespace {

CharucoLayout LayoutOf(const BoardSpec& board) {
  CharucoLayout layout;
  layout.num_squares_x = board.num_corners_x + 1;
  layout.num_squares_y = board.num_corners_y + 1;
  layout.square_m = static_cast<float>(board.square_m);
  layout.marker_m = static_cast<float>(board.marker_m);
  layout.dictionary = NumberOfDictionary(board.dictionary);
  return layout;
}

// Corners beside at least one marker: where OpenCV puts them by the markers nearby, then to
// sub-pixel accuracy within the rim that markers leave free, and only where the four squares
// differ.
CharucoCorners CornersBetween(const Markers& markers,
                              const cv::Mat& grey,
                              const CharucoLayout& layout,
                              const BoardSpec& board) {
  const auto [near, near_ids] = CornersBesideMarkers(grey, markers, layout);
  if (near.size() < 4) return {};
  // From the board, in squares, to the image: good enough for the size and shade of squares.
  std::vector<cv::Point2f> near_squares;
  for (const int id : near_ids) {
    near_squares.emplace_back(id % board.num_corners_x, id / board.num_corners_x);
  }
  const cv::Mat H = cv::findHomography(near_squares, near);
  if (H.empty()) return {};
  CharucoCorners kept;
  for (std::size_t n = 0; n < near.size(); ++n) {
    std::vector<cv::Point2f> ends;
    const cv::Point2f at = near_squares[n];
    cv::perspectiveTransform(
        std::vector<cv::Point2f>{at, at + cv::Point2f(1, 0), at + cv::Point2f(0, 1)}, ends, H);
    const cv::Point2f step_x = ends[1] - ends[0];
    const cv::Point2f step_y = ends[2] - ends[0];
    const double rim_squares = (1 - board.marker_m / board.square_m) / 2;
    const auto corner = RefinedCorner(grey, near[n], step_x, step_y, rim_squares);
    if (!corner) continue;
    kept.corners_px.emplace_back(static_cast<float>(corner->x()), static_cast<float>(corner->y()));
    kept.ids.push_back(near_ids[n]);
  }
  return kept;
}

}  // namespace

Expected<std::vector<Eigen::Vector2d>, CameraBoardMiss> FindCharucoCorners(const cv::Mat& grey,
                                                                           const BoardSpec& board) {
  const CharucoLayout layout = LayoutOf(board);
  const Markers markers = DetectMarkers(grey, layout.dictionary);
  if (markers.ids.empty()) {
    return CameraBoardMiss{CameraBoardFault::kNoBoard,
                           "none of " + std::to_string(markers.num_rejected) +
                               " dark squares is a marker of " + board.dictionary};
  }
  const auto [found, ids] = CornersBetween(markers, grey, layout, board);

  std::vector<Eigen::Vector2d> corners_px(
      static_cast<std::size_t>(board.num_corners_x) * board.num_corners_y,
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (std::size_t n = 0; n < ids.size(); ++n) {
    // OpenCV counts rows from the top of the print.
    const int column = ids[n] % board.num_corners_x;
    const int row = board.num_corners_y - 1 - ids[n] / board.num_corners_x;
    corners_px[row * board.num_corners_x + column] = {found[n].x, found[n].y};
  }
  return EnoughCorners(corners_px, markers.ids.size(), board);
}

cv::Mat DrawCharuco(const BoardSpec& board, int pixels_per_square) {
  return DrawCharucoLayout(LayoutOf(board),
                           {(board.num_corners_x + 1) * pixels_per_square,
                            (board.num_corners_y + 1) * pixels_per_square});
}

}  // namespace voqcal
