#include "core/board/metres_per_pixel.hpp"

namespace voqcal {

double MetresPerPixel(const BoardPose& pose_camera, const CameraModel& camera) {
  double sum_m = 0.0;
  double sum_px = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Eigen::Vector3d& from_m = pose_camera.corners_m[i];
    const Eigen::Vector3d& to_m = pose_camera.corners_m[i + 2];
    sum_m += (to_m - from_m).norm();
    sum_px += (camera.Project(to_m) - camera.Project(from_m)).norm();
  }
  return sum_m / sum_px;
}

}  // namespace voqcal
