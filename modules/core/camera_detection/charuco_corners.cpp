#include "core/camera_detection/charuco_corners.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/camera_detection/charuco_opencv.hpp"
#include "core/camera_detection/missing_corners.hpp"

namespace voqcal {
namespace {

CharucoLayout LayoutOf(const BoardSpec& board) {
  CharucoLayout layout;
  layout.num_squares_x = board.num_corners_x + 1;
  layout.num_squares_y = board.num_corners_y + 1;
  layout.square_m = static_cast<float>(board.square_m);
  layout.marker_m = static_cast<float>(board.marker_m);
  // The dictionary's place in the list is OpenCV's number of it.
  const auto& names = CharucoDictionaries();
  const auto name = std::find(names.begin(), names.end(), board.dictionary);
  layout.dictionary = static_cast<int>(name - names.begin());
  return layout;
}

// Whether the seen corners span a plane: at least a square's width off any line.
bool IsPlanar(const std::vector<Eigen::Vector3d>& seen_board_m, double square_m) {
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(seen_board_m.size()));
  for (std::size_t i = 0; i < seen_board_m.size(); ++i) points.col(i) = seen_board_m[i];
  const Eigen::Vector3d mean = points.rowwise().mean();
  points.colwise() -= mean;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(points * points.transpose());
  // A line of n corners with one beside it: n / (n + 1) squares^2 across the line.
  return svd.singularValues()(1) > 0.5 * square_m * square_m;
}

// Corners beside at least one marker: where OpenCV puts them by the markers nearby, then to
// sub-pixel accuracy within the rim that markers leave free, and only where the four squares
// differ.
CharucoCorners CornersBetween(const CharucoMarkers& markers,
                              const cv::Mat& grey,
                              const CharucoLayout& layout,
                              const BoardSpec& board) {
  constexpr double kMaxShiftSquares = 0.1;
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
    const double side_px = std::min(cv::norm(step_x), cv::norm(step_y));
    const double rim_squares = (1 - board.marker_m / board.square_m) / 2;
    const int half_window_px = std::clamp(static_cast<int>(rim_squares * side_px), 2, 30);
    std::vector<cv::Point2f> corner{near[n]};
    try {
      cv::cornerSubPix(grey,
                       corner,
                       {half_window_px, half_window_px},
                       {-1, -1},
                       {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-4});
    } catch (const cv::Exception&) {
      continue;  // too near to the image's border
    }
    if (cv::norm(corner[0] - near[n]) > std::max(1.0, kMaxShiftSquares * side_px)) continue;
    // A quarter of these steps is in the middle of the rim.
    const auto rim = static_cast<float>(2 * rim_squares);
    if (QuarterContrast(grey, corner[0], rim * step_x, rim * step_y) == 0) continue;
    kept.corners_px.push_back(corner[0]);
    kept.ids.push_back(near_ids[n]);
  }
  return kept;
}

}  // namespace

Expected<std::vector<Eigen::Vector2d>, CameraBoardMiss> FindCharucoCorners(const cv::Mat& grey,
                                                                           const BoardSpec& board) {
  const CharucoLayout layout = LayoutOf(board);
  const CharucoMarkers markers = DetectCharucoMarkers(grey, layout);
  if (markers.ids.empty()) {
    return CameraBoardMiss{CameraBoardFault::kNoBoard,
                           "none of " + std::to_string(markers.num_rejected) +
                               " dark squares is a marker of " + board.dictionary};
  }
  const auto [found, ids] = CornersBetween(markers, grey, layout, board);

  const std::vector<Eigen::Vector3d> all_board_m = board.InnerCornersBoardM();
  std::vector<Eigen::Vector2d> corners_px(
      all_board_m.size(), Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  std::vector<Eigen::Vector3d> seen_board_m;
  for (std::size_t n = 0; n < ids.size(); ++n) {
    // OpenCV counts rows from the top of the print.
    const int column = ids[n] % board.num_corners_x;
    const int row = board.num_corners_y - 1 - ids[n] / board.num_corners_x;
    const int k = row * board.num_corners_x + column;
    corners_px[k] = {found[n].x, found[n].y};
    seen_board_m.push_back(all_board_m[k]);
  }
  constexpr std::size_t kMinCorners = 6;
  if (seen_board_m.size() < kMinCorners || !IsPlanar(seen_board_m, board.square_m)) {
    return CameraBoardMiss{
        CameraBoardFault::kPartlyHidden,
        std::to_string(markers.ids.size()) + " markers and " + std::to_string(seen_board_m.size()) +
            " of " + std::to_string(all_board_m.size()) + " corners: at least 6, not on a line"};
  }
  return corners_px;
}

cv::Mat DrawCharuco(const BoardSpec& board, int pixels_per_square) {
  return DrawCharucoLayout(LayoutOf(board),
                           {(board.num_corners_x + 1) * pixels_per_square,
                            (board.num_corners_y + 1) * pixels_per_square});
}

}  // namespace voqcal
