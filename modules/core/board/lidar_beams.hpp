#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// One return as what was measured: a direction and a range.
struct LidarBeam {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< Unit length, lidar frame.
  double range_m = 0.0;
  std::uint32_t point = 0;  ///< Its index in the cloud.

  Eigen::Vector3d PositionM() const { return range_m * direction; }
};

/// The returns of a cloud at `min_range_m` or farther, in the cloud's order. Points that are not
/// finite or lie at the origin (beams without a return) are left out.
std::vector<LidarBeam> ValidBeams(const PointCloud& cloud_lidar_m, double min_range_m);

}  // namespace voqcal
