#include "core/lidar_detection/board_measurement.hpp"

#include <algorithm>
#include <cmath>

#include "core/lidar_detection/detection_tolerances.hpp"

namespace voqcal {

Eigen::Isometry3d TransformOf(const PlaneFrame& frame, const RectanglePose& pose) {
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d R;
  R.col(0) = std::cos(pose.angle_rad) * frame.e1 + std::sin(pose.angle_rad) * frame.e2;
  R.col(2) = frame.plane.normal;
  R.col(1) = R.col(2).cross(R.col(0));
  T_lidar_board.linear() = R;
  T_lidar_board.translation() = frame.ToLidar(pose.centre_m);
  return T_lidar_board;
}

double SpacingM(const Measurement& m) {
  const auto num = static_cast<double>(std::max(m.board_hits.size(), kMinBoardHits));
  return std::sqrt(m.model.width_m * m.model.height_m / num);
}

std::vector<std::uint16_t> RingsOf(const Measurement& m, const PointCloud& cloud_lidar_m) {
  std::vector<std::uint16_t> rings;
  if (!cloud_lidar_m.has_ring) return rings;
  for (const std::size_t i : m.board_hits) {
    rings.push_back(cloud_lidar_m.points[m.view.Beam(i).point].ring);
  }
  return rings;
}

}  // namespace voqcal
