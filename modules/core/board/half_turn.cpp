#include "core/board/half_turn.hpp"

#include <algorithm>
#include <cmath>

namespace voqcal {
namespace {

double SquaredCornerDistance(const BoardPose& pose_lidar,
                             const BoardPose& pose_camera,
                             const Eigen::Isometry3d& T_camera_lidar) {
  double sum_m2 = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum_m2 += (T_camera_lidar * pose_lidar.corners_m[i] - pose_camera.corners_m[i]).squaredNorm();
  }
  return sum_m2;
}

}  // namespace

bool IsSquare(double width_m, double height_m) {
  return std::abs(width_m - height_m) < 0.05 * std::max(width_m, height_m);
}

BoardPose TurnedByQuarters(const BoardPose& pose, int num_quarters) {
  BoardPose turned = pose;
  for (std::size_t i = 0; i < 4; ++i) {
    turned.corners_m[i] = pose.corners_m[(i + static_cast<std::size_t>(num_quarters)) % 4];
  }
  return turned;
}

int BestTurn(const BoardPose& pose, const std::function<double(const BoardPose&)>& cost) {
  const auto& c = pose.corners_m;
  const int step = IsSquare((c[1] - c[0]).norm(), (c[2] - c[1]).norm()) ? 1 : 2;
  int best = 0;
  double least = cost(pose);
  for (int num_quarters = step; num_quarters < 4; num_quarters += step) {
    const double turned = cost(TurnedByQuarters(pose, num_quarters));
    if (!(turned < least)) continue;
    least = turned;
    best = num_quarters;
  }
  return best;
}

BoardPose LidarPoseInCameraOrder(const BoardSample& sample,
                                 const Eigen::Isometry3d& T_camera_lidar) {
  const auto cost = [&](const BoardPose& pose) {
    return SquaredCornerDistance(pose, sample.camera.pose, T_camera_lidar);
  };
  return TurnedByQuarters(sample.lidar.pose, BestTurn(sample.lidar.pose, cost));
}

}  // namespace voqcal
