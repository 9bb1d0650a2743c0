#include "core/estimation/sighting_errors.hpp"

#include <cmath>

namespace voqcal {

SightingVariances SquaresOf(const SightingErrors& errors) {
  return {errors.along_ray_m * errors.along_ray_m,
          errors.level_m * errors.level_m,
          errors.upright_m * errors.upright_m,
          errors.tilt_rad * errors.tilt_rad,
          errors.turn_rad * errors.turn_rad};
}

SightingErrors RootsOf(const SightingVariances& v) {
  return {std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3]), std::sqrt(v[4])};
}

std::array<Matrix6d, kNumSightingErrors> UnitCovariances(const BoardPose& pose_camera,
                                                         const Eigen::Matrix3d& R_camera_lidar) {
  const Eigen::Vector3d ray = pose_camera.centre_m.normalized();
  const Eigen::Matrix3d along_ray = ray * ray.transpose();
  const Eigen::Matrix3d along_normal = pose_camera.normal * pose_camera.normal.transpose();
  // A ray along the lidar's z has no level: then any.
  const Eigen::Vector3d up = R_camera_lidar.col(2);
  const Eigen::Vector3d across_up = up.cross(ray);
  constexpr double kLeastSine = 1e-6;
  const Eigen::Vector3d level =
      across_up.norm() > kLeastSine ? across_up.normalized() : ray.unitOrthogonal();
  const Eigen::Vector3d upright = ray.cross(level);
  std::array<Matrix6d, kNumSightingErrors> units;
  units.fill(Matrix6d::Zero());
  units[kAlongRayError].bottomRightCorner<3, 3>() = along_ray;
  units[kLevelError].bottomRightCorner<3, 3>() = level * level.transpose();
  units[kUprightError].bottomRightCorner<3, 3>() = upright * upright.transpose();
  units[kTiltError].topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() - along_normal;
  units[kTurnError].topLeftCorner<3, 3>() = along_normal;
  return units;
}

Matrix6d SightingErrors::CovarianceOf(const BoardPose& pose_camera,
                                      const Eigen::Matrix3d& R_camera_lidar) const {
  const auto units = UnitCovariances(pose_camera, R_camera_lidar);
  const SightingVariances variances = SquaresOf(*this);
  Matrix6d covariance = Matrix6d::Zero();
  for (std::size_t k = 0; k < kNumSightingErrors; ++k) covariance += variances[k] * units[k];
  return covariance;
}

}  // namespace voqcal
