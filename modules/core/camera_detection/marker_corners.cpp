#include "core/camera_detection/marker_corners.hpp"

#include <algorithm>
#include <string>

#include <Eigen/SVD>

#include "core/camera_detection/missing_corners.hpp"
#include "core/camera_detection/x_corner_fit.hpp"

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

std::optional<Eigen::Vector2d> RefinedCorner(const cv::Mat& grey,
                                             const cv::Point2f& near_px,
                                             const cv::Point2f& step_x_px,
                                             const cv::Point2f& step_y_px,
                                             double rim_squares) {
  const auto reach = [&](const cv::Point2f& step_px) -> Eigen::Vector2d {
    constexpr double kShareOfRim = 0.8;  // blur brings the edge beyond nearer
    constexpr double kMinPx = 2;
    constexpr double kMaxPx = 7;  // lenses bend edges: 15 px of one by 0.02 px in a wide view
    const double length_px = cv::norm(step_px);
    const double reach_px = std::clamp(kShareOfRim * rim_squares * length_px, kMinPx, kMaxPx);
    return Eigen::Vector2d(step_px.x, step_px.y) * (reach_px / length_px);
  };
  const auto corner_px =
      FitXCorner(grey, {{near_px.x, near_px.y}, reach(step_x_px), reach(step_y_px)});
  if (!corner_px) return {};
  // A quarter of these steps is in the middle of the rim.
  const auto rim = static_cast<float>(2 * rim_squares);
  const cv::Point2f at_px(static_cast<float>(corner_px->x()), static_cast<float>(corner_px->y()));
  if (QuarterContrast(grey, at_px, rim * step_x_px, rim * step_y_px) == 0) return {};
  return corner_px;
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
