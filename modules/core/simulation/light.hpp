#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace voqcal {

/// How brightly a spot is lit: the hall's even light, and a lamp under the ceiling.
inline double LightAt(const Eigen::Vector3d& point_lidar_m, const Eigen::Vector3d& normal_lidar) {
  const Eigen::Vector3d to_lamp = Eigen::Vector3d(0.5, 0.5, 1.7) - point_lidar_m;
  const double cosine = std::max(0.0, normal_lidar.dot(to_lamp) / (to_lamp.norm() + 1e-9));
  return 0.7 + 0.35 * cosine / (1.0 + 0.04 * to_lamp.squaredNorm());
}

}  // namespace voqcal
