#include "core/board/lidar_beams.hpp"

#include <algorithm>
#include <cstddef>

namespace voqcal {

std::vector<LidarBeam> ValidBeams(const PointCloud& cloud_lidar_m, double min_range_m) {
  constexpr double kMinRangeM = 1e-3;  // the origin stands for "no return"
  constexpr double kMaxRangeM = 1e4;   // beyond any lidar: a broken value
  const double nearest_m = std::max(min_range_m, kMinRangeM);
  std::vector<LidarBeam> beams;
  beams.reserve(cloud_lidar_m.points.size());
  for (std::size_t i = 0; i < cloud_lidar_m.points.size(); ++i) {
    const Eigen::Vector3d position_m = cloud_lidar_m.points[i].position_m.cast<double>();
    const double range_m = position_m.norm();
    if (!(range_m >= nearest_m && range_m < kMaxRangeM)) continue;  // also catches NaN
    beams.push_back({position_m / range_m, range_m, static_cast<std::uint32_t>(i)});
  }
  return beams;
}

}  // namespace voqcal
