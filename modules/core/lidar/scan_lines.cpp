#include "core/lidar/scan_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

namespace voqcal {
namespace {

constexpr double kNoReturn = std::numeric_limits<double>::quiet_NaN();

/// Above the plane across axis `axis`, radians; NaN without a return.
double ElevationRad(const LidarPoint& point, int axis) {
  const Eigen::Vector3d p_m = point.position_m.cast<double>();
  const double range_m = p_m.norm();
  if (!(range_m > 1e-3) || !std::isfinite(range_m)) return kNoReturn;
  return std::asin(std::clamp(p_m[axis] / range_m, -1.0, 1.0));
}

/// The line of each bin of elevation: bins with points next to each other are one.
class ElevationLines {
 public:
  explicit ElevationLines(const std::vector<double>& elevations_rad) : counts_(kNumBins, 0) {
    for (const double elevation_rad : elevations_rad) {
      if (std::isfinite(elevation_rad)) ++counts_[BinOf(elevation_rad)];
    }
    lines_.assign(kNumBins, 0);
    bool is_in_line = false;
    int num_in_line = 0;
    std::size_t width = 0;
    for (std::size_t i = 0; i < kNumBins; ++i) {
      if (counts_[i] == 0) {
        if (is_in_line) Close(num_in_line, width);
        is_in_line = false;
        continue;
      }
      if (!is_in_line) num_in_line = 0, width = 0;
      is_in_line = true;
      num_in_line += counts_[i];
      ++width;
      lines_[i] = static_cast<std::uint16_t>(num_lines_);
    }
    if (is_in_line) Close(num_in_line, width);
  }

  /// Lines of many points each, narrow beside the gaps between them.
  bool AreClear() const {
    constexpr int kMinLines = 4;
    constexpr int kMaxLines = 256;
    constexpr double kMinShare = 0.98;  // of the points; single ones may be stray
    return num_lines_ >= kMinLines && num_lines_ <= kMaxLines &&
           num_in_full_ >= kMinShare * num_points_;
  }

  std::uint16_t LineOf(double elevation_rad) const { return lines_[BinOf(elevation_rad)]; }

 private:
  static constexpr std::size_t kNumBins = 9000;  // 0.02 degrees each

  static std::size_t BinOf(double elevation_rad) {
    const double share = elevation_rad / M_PI + 0.5;
    return std::min(static_cast<std::size_t>(share * kNumBins), kNumBins - 1);
  }

  void Close(int num_in_line, std::size_t width) {
    constexpr int kFull = 8;
    constexpr std::size_t kMaxWidth = 12;  // a quarter of a degree
    num_points_ += num_in_line;
    if (num_in_line >= kFull && width <= kMaxWidth) num_in_full_ += num_in_line;
    ++num_lines_;
  }

  std::vector<int> counts_;
  std::vector<std::uint16_t> lines_;
  int num_lines_ = 0;
  double num_points_ = 0;
  double num_in_full_ = 0;
};

}  // namespace

std::vector<std::uint16_t> ScanLinesOf(const PointCloud& cloud_lidar_m) {
  for (const int axis : {2, 0, 1}) {
    std::vector<double> elevations_rad;
    elevations_rad.reserve(cloud_lidar_m.points.size());
    for (const LidarPoint& point : cloud_lidar_m.points) {
      elevations_rad.push_back(ElevationRad(point, axis));
    }
    const ElevationLines lines(elevations_rad);
    if (!lines.AreClear()) continue;
    std::vector<std::uint16_t> line_of(elevations_rad.size(), 0);
    for (std::size_t i = 0; i < line_of.size(); ++i) {
      if (std::isfinite(elevations_rad[i])) line_of[i] = lines.LineOf(elevations_rad[i]);
    }
    return line_of;
  }
  return {};
}

bool AreRingsScanLines(const PointCloud& cloud_lidar_m) {
  constexpr double kMaxShare = 0.1;  // of the whole variance; a VLP-16's lines leave a thousandth
  // A few thousand points tell it; an odd step takes all lines, however many are a power of two.
  const std::size_t step = (cloud_lidar_m.points.size() / 3000) | 1;
  struct Sums {
    double num = 0.0, sum = 0.0, squares = 0.0;
    void Add(double value) {
      num += 1;
      sum += value;
      squares += value * value;
    }
    double Scatter() const { return num > 0 ? squares - sum * sum / num : 0.0; }
  };
  for (const int axis : {2, 0, 1}) {
    Sums all;
    std::map<std::uint16_t, Sums> of_rings;
    for (std::size_t i = 0; i < cloud_lidar_m.points.size(); i += step) {
      const double elevation_rad = ElevationRad(cloud_lidar_m.points[i], axis);
      if (!std::isfinite(elevation_rad)) continue;
      all.Add(elevation_rad);
      of_rings[cloud_lidar_m.points[i].ring].Add(elevation_rad);
    }
    double within = 0.0;
    for (const auto& [ring, sums] : of_rings) within += sums.Scatter();
    if (of_rings.size() > 1 && within < kMaxShare * all.Scatter()) return true;
  }
  return false;
}

}  // namespace voqcal
