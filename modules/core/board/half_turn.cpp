#include "core/board/half_turn.hpp"

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

BoardPose LidarPoseInCameraOrder(const BoardSample& sample,
                                 const Eigen::Isometry3d& T_camera_lidar) {
  const BoardPose& as_is = sample.lidar.pose;
  const BoardPose turned = TurnedByHalf(as_is);
  return SquaredCornerDistance(turned, sample.camera.pose, T_camera_lidar) <
                 SquaredCornerDistance(as_is, sample.camera.pose, T_camera_lidar)
             ? turned
             : as_is;
}

}  // namespace voqcal
