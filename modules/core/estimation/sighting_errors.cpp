#include "core/estimation/sighting_errors.hpp"

#include <cmath>

namespace voqcal {

SightingVariances SquaresOf(const SightingErrors& errors) {
  return {errors.along_ray_m * errors.along_ray_m,
          errors.across_ray_m * errors.across_ray_m,
          errors.tilt_rad * errors.tilt_rad,
          errors.turn_rad * errors.turn_rad};
}

SightingErrors RootsOf(const SightingVariances& v) {
  return {std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}

std::array<Matrix6d, 4> UnitCovariances(const BoardPose& pose_camera) {
  const Eigen::Vector3d ray = pose_camera.centre_m.normalized();
  const Eigen::Matrix3d along_ray = ray * ray.transpose();
  const Eigen::Matrix3d along_normal = pose_camera.normal * pose_camera.normal.transpose();
  std::array<Matrix6d, 4> units;
  units.fill(Matrix6d::Zero());
  units[0].bottomRightCorner<3, 3>() = along_ray;
  units[1].bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() - along_ray;
  units[2].topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() - along_normal;
  units[3].topLeftCorner<3, 3>() = along_normal;
  return units;
}

Matrix6d SightingErrors::CovarianceOf(const BoardPose& pose_camera) const {
  const auto units = UnitCovariances(pose_camera);
  return along_ray_m * along_ray_m * units[0] + across_ray_m * across_ray_m * units[1] +
         tilt_rad * tilt_rad * units[2] + turn_rad * turn_rad * units[3];
}

}  // namespace voqcal
