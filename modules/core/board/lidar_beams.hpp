#pragma once

#include <array>
#include <cstddef>
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

/// Whether the i-th of `num` things is among about `share` evenly taken ones. Multiples of the
/// golden ratio modulo 1 fall evenly (Weyl) in step with no scan pattern; every n-th beam of an
/// ordered sweep may be one ring.
bool IsInShare(std::size_t i, std::size_t share, std::size_t num);

/// Beams by direction: those of a cone are found without looking at all.
class BeamIndex {
 public:
  explicit BeamIndex(const std::vector<LidarBeam>& beams);

  /// Appends the beams within `half_angle_rad` of `axis` (unit length).
  void AppendCone(const Eigen::Vector3d& axis,
                  double half_angle_rad,
                  std::vector<LidarBeam>* cone) const;

 private:
  static constexpr std::size_t kNumSectors = 128;  // about 3 degrees of azimuth each

  std::vector<LidarBeam> beams_;                      // by sector, then as they came
  std::array<std::size_t, kNumSectors + 1> begin_{};  // of each sector
};

}  // namespace voqcal
