#include "core/lidar_detection/lidar_beams.hpp"

#include <algorithm>
#include <cmath>

namespace voqcal {
namespace {

constexpr std::uint8_t kNoSector = 255;

double SlopeOf(double x, double y, double z) {
  constexpr double kTiny = 1e-9;  // straight up or down is steep enough
  return z / std::max(std::sqrt(x * x + y * y), kTiny);
}

std::size_t SectorOf(double pseudo_azimuth, std::size_t num_sectors) {
  return static_cast<std::size_t>(pseudo_azimuth / 4.0 * static_cast<double>(num_sectors)) %
         num_sectors;
}

}  // namespace

double PseudoAzimuth(double x, double y) {
  const double sum = std::abs(x) + std::abs(y);
  if (sum == 0.0) return 0.0;
  const double ratio = y / sum;
  if (x < 0) return 2.0 - ratio;
  return ratio < 0 ? 4.0 + ratio : ratio;
}

bool IsReturn(const Eigen::Vector3f& position_m, double min_range_m) {
  constexpr double kMinRangeM = 1e-3;  // the origin stands for "no return"
  constexpr double kMaxRangeM = 1e4;   // beyond any lidar: a broken value
  const double nearest_m = std::max(min_range_m, kMinRangeM);
  const double square_m2 = position_m.cast<double>().squaredNorm();
  // Also false for NaN.
  return square_m2 >= nearest_m * nearest_m && square_m2 < kMaxRangeM * kMaxRangeM;
}

bool IsInShare(std::size_t i, std::size_t share, std::size_t num) {
  if (share >= num) return true;
  const auto place = static_cast<std::uint32_t>(i * 0x9E3779B9U);  // i * golden ratio * 2^32
  return static_cast<double>(place) * static_cast<double>(num) <
         4294967296.0 * static_cast<double>(share);
}

BeamIndex::BeamIndex(const PointCloud& cloud_lidar_m,
                     double min_range_m,
                     const Eigen::Matrix3d& R_axes_lidar)
    : cloud_lidar_m_(&cloud_lidar_m), R_axes_lidar_(R_axes_lidar) {
  const std::vector<LidarPoint>& points = cloud_lidar_m.points;
  const Eigen::Matrix3f R = R_axes_lidar.cast<float>();
  std::vector<std::uint8_t> sectors(points.size(), kNoSector);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!IsReturn(points[i].position_m, min_range_m)) continue;
    const Eigen::Vector3f position_m = R * points[i].position_m;
    const std::size_t sector = SectorOf(PseudoAzimuth(position_m.x(), position_m.y()), kNumSectors);
    sectors[i] = static_cast<std::uint8_t>(sector);
    ++begin_[sector + 1];
    const double slope = SlopeOf(position_m.x(), position_m.y(), position_m.z());
    lowest_slope_ = std::min(lowest_slope_, slope);
    highest_slope_ = std::max(highest_slope_, slope);
  }
  for (std::size_t i = 0; i < kNumSectors; ++i) begin_[i + 1] += begin_[i];
  points_.resize(begin_[kNumSectors]);
  std::array<std::size_t, kNumSectors + 1> next = begin_;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (sectors[i] != kNoSector) points_[next[sectors[i]]++] = static_cast<std::uint32_t>(i);
  }
}

bool BeamIndex::Covers(const Eigen::Vector3d& direction_lidar) const {
  const Eigen::Vector3d direction = R_axes_lidar_ * direction_lidar;
  const double slope = SlopeOf(direction.x(), direction.y(), direction.z());
  if (slope < lowest_slope_ || slope > highest_slope_) return false;
  const std::size_t sector = SectorOf(PseudoAzimuth(direction.x(), direction.y()), kNumSectors);
  return begin_[sector] < begin_[sector + 1];
}

void BeamIndex::AppendCone(const Eigen::Vector3d& axis_lidar,
                           double half_angle_rad,
                           std::vector<LidarBeam>* cone) const {
  const Eigen::Vector3d axis = R_axes_lidar_ * axis_lidar;
  const double cosine = std::cos(half_angle_rad);
  const double level = axis.head<2>().norm();
  std::size_t first = 0;
  std::size_t num_sectors = kNumSectors;
  // A circle of angular radius h at elevation e spans +-asin(sin h / cos e) of azimuth, unless it
  // contains the vertical.
  const double sine = std::sin(half_angle_rad);
  if (cosine > 0 && sine < level) {
    const double azimuth_rad = std::atan2(axis.y(), axis.x());
    const double span_rad = std::asin(sine / level);
    const auto sector_at = [](double angle_rad) {
      return SectorOf(PseudoAzimuth(std::cos(angle_rad), std::sin(angle_rad)), kNumSectors);
    };
    first = sector_at(azimuth_rad - span_rad);
    const std::size_t last = sector_at(azimuth_rad + span_rad);
    num_sectors = (last + kNumSectors - first) % kNumSectors + 1;
  }
  for (std::size_t k = 0; k < num_sectors; ++k) {
    const std::size_t sector = (first + k) % kNumSectors;
    for (std::size_t i = begin_[sector]; i < begin_[sector + 1]; ++i) {
      const Eigen::Vector3d position_m =
          cloud_lidar_m_->points[points_[i]].position_m.cast<double>();
      const double range_m = position_m.norm();
      if (axis_lidar.dot(position_m) <= cosine * range_m) continue;
      cone->push_back({position_m / range_m, range_m, points_[i]});
    }
  }
}

}  // namespace voqcal
