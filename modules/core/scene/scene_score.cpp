#include "core/scene/scene_score.hpp"

#include <cmath>
#include <limits>

namespace voqcal {
namespace {

// Pixel coordinates in the reduced image: its pixel (0, 0) covers the first `reduction` pixels.
Eigen::Vector2d Reduced(const Eigen::Vector2d& pixel_px, double reduction) {
  return ((pixel_px.array() + 0.5) / reduction - 0.5).matrix();
}

// Rank at a place between pixels, 0 to 1; negative outside the image and on the board.
double RankAt(const SceneView& view, const Eigen::Vector2d& pixel_px) {
  const Eigen::Vector2d at = Reduced(pixel_px, view.reduction);
  const double left = std::floor(at.x());
  const double top = std::floor(at.y());
  const bool is_inside = left >= 0 && top >= 0 && left + 1 < view.edge_rank.cols &&
                         top + 1 < view.edge_rank.rows;  // false for NaN
  if (!is_inside) return -1;
  const int x = static_cast<int>(left);
  const int y = static_cast<int>(top);
  const uchar* upper = view.edge_rank.ptr<uchar>(y) + x;
  const uchar* lower = view.edge_rank.ptr<uchar>(y + 1) + x;
  if (upper[0] == 0 || upper[1] == 0 || lower[0] == 0 || lower[1] == 0) return -1;
  const double fx = at.x() - left;
  const double fy = at.y() - top;
  const double rank =
      (1 - fy) * ((1 - fx) * upper[0] + fx * upper[1]) + fy * ((1 - fx) * lower[0] + fx * lower[1]);
  return (rank - 1) / 254;
}

}  // namespace

double MeanEdgeRank(const std::vector<SceneView>& views,
                    const CameraModel& camera,
                    const Eigen::Isometry3d& T_camera_lidar) {
  double sum = 0;
  int num_seen = 0;
  for (const SceneView& view : views) {
    for (const DepthEdge& edge : view.edges) {
      const Eigen::Vector3d position_camera_m =
          T_camera_lidar * edge.position_lidar_m.cast<double>();
      const auto pixel_px = camera.ProjectIfInFront(position_camera_m);
      if (!pixel_px) continue;
      const double rank = RankAt(view, *pixel_px);
      if (rank < 0) continue;
      sum += rank;
      ++num_seen;
    }
  }
  return num_seen == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / num_seen;
}

}  // namespace voqcal
