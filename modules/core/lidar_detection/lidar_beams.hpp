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

/// Whether a point is a return at `min_range_m` or farther: finite, not the origin (a beam without
/// a return), nearer than any broken value.
bool IsReturn(const Eigen::Vector3f& position_m, double min_range_m);

/// Grows with the azimuth from 0 to 4 in a turn, without trigonometry.
double PseudoAzimuth(double x, double y);

/// Whether the i-th of `num` things is among about `share` evenly taken ones. Multiples of the
/// golden ratio modulo 1 fall evenly (Weyl) in step with no scan pattern; every n-th beam of an
/// ordered sweep may be one ring.
bool IsInShare(std::size_t i, std::size_t share, std::size_t num);

/// The returns of a cloud by direction: those of a cone are found without looking at all.
class BeamIndex {
 public:
  /// @param cloud_lidar_m  borrowed; its returns nearer than `min_range_m` are left out.
  /// @param R_axes_lidar  z about the axis that the sensor spins about, if it does: then sectors
  ///     have as many beams each.
  BeamIndex(const PointCloud& cloud_lidar_m,
            double min_range_m,
            const Eigen::Matrix3d& R_axes_lidar = Eigen::Matrix3d::Identity());

  const Eigen::Matrix3d& R_axes_lidar() const { return R_axes_lidar_; }

  /// Whether the sensor looks in a direction at all: about the axes, other returns are as high and
  /// as low, and some have its azimuth. Then a beam without a return has met the sky.
  bool Covers(const Eigen::Vector3d& direction_lidar) const;

  /// Appends the beams within `half_angle_rad` of `axis_lidar` (unit length).
  void AppendCone(const Eigen::Vector3d& axis_lidar,
                  double half_angle_rad,
                  std::vector<LidarBeam>* cone) const;

 private:
  static constexpr std::size_t kNumSectors = 128;  // about 3 degrees of azimuth each

  const PointCloud* cloud_lidar_m_;
  Eigen::Matrix3d R_axes_lidar_;
  std::vector<std::uint32_t> points_;                 // by sector, then as they came
  std::array<std::size_t, kNumSectors + 1> begin_{};  // of each sector
  double lowest_slope_ = 0.0;                         // z over the distance from the axis...
  double highest_slope_ = 0.0;                        // ...of all returns
};

}  // namespace voqcal
