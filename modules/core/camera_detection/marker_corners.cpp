#include "core/camera_detection/marker_corners.hpp"

#include <algorithm>
#include <string>

#include <Eigen/SVD>
#include <opencv2/imgproc.hpp>

#include "core/camera_detection/missing_corners.hpp"

namespace voqcal {
namespace {

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

}  // namespace

std::optional<cv::Point2f> RefinedCorner(const cv::Mat& grey,
                                         const cv::Point2f& near_px,
                                         const cv::Point2f& step_x_px,
                                         const cv::Point2f& step_y_px,
                                         double rim_squares) {
  constexpr double kMaxShiftSquares = 0.1;
  const double side_px = std::min(cv::norm(step_x_px), cv::norm(step_y_px));
  const int half_window_px = std::clamp(static_cast<int>(rim_squares * side_px), 2, 30);
  std::vector<cv::Point2f> corner{near_px};
  try {
    cv::cornerSubPix(grey,
                     corner,
                     {half_window_px, half_window_px},
                     {-1, -1},
                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-4});
  } catch (const cv::Exception&) {
    return {};  // too near to the image's border
  }
  if (cv::norm(corner[0] - near_px) > std::max(1.0, kMaxShiftSquares * side_px)) return {};
  // A quarter of these steps is in the middle of the rim.
  const auto rim = static_cast<float>(2 * rim_squares);
  if (QuarterContrast(grey, corner[0], rim * step_x_px, rim * step_y_px) == 0) return {};
  return corner[0];
}

Expected<std::vector<Eigen::Vector2d>, CameraBoardMiss> EnoughCorners(
    const std::vector<Eigen::Vector2d>& corners_px,
    std::size_t num_markers,
    const BoardSpec& board) {
  constexpr std::size_t kMinCorners = 6;
  const std::vector<Eigen::Vector3d> all_board_m = board.InnerCornersBoardM();
  std::vector<Eigen::Vector3d> seen_board_m;
  for (std::size_t k = 0; k < all_board_m.size(); ++k) {
    if (corners_px[k].allFinite()) seen_board_m.push_back(all_board_m[k]);
  }
  if (seen_board_m.size() >= kMinCorners && IsPlanar(seen_board_m, board.square_m)) {
    return corners_px;
  }
  return CameraBoardMiss{
      CameraBoardFault::kPartlyHidden,
      std::to_string(num_markers) + " markers and " + std::to_string(seen_board_m.size()) + " of " +
          std::to_string(all_board_m.size()) + " corners: at least 6, not on a line"};
}

}  // namespace voqcal
