#include "core/lidar/cloud_fields.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

namespace voqcal {
namespace {

using Words = std::vector<std::string_view>;

/// The first that is there counts. scalar_...: CloudCompare's.
const Words& NamesOf(std::string_view field) {
  static const std::map<std::string_view, Words> kNames = {
      {"x", {"x"}},
      {"y", {"y"}},
      {"z", {"z"}},
      {"intensity",
       {"intensity",
        "intensities",
        "reflectivity",
        "reflectance",
        "remission",
        "i",
        "scalar_intensity"}},
      {"ring", {"ring", "channel", "line", "laser_id", "laserid", "beam", "scalar_ring"}},
      {"time",
       {"time",
        "t",
        "timestamp",
        "time_stamp",
        "offset_time",
        "time_offset",
        "timeoffset",
        "scalar_time"}},
      {"return_number",
       {"return_number",
        "returnnumber",
        "return_num",
        "echo_number",
        "echo",
        "scalar_returnnumber"}},
  };
  return kNames.at(field);
}

bool IsSame(std::string_view name, std::string_view in_small_letters) {
  return std::equal(name.begin(),
                    name.end(),
                    in_small_letters.begin(),
                    in_small_letters.end(),
                    [](unsigned char a, char b) { return std::tolower(a) == b; });
}

bool HasReturn(const LidarPoint& point) {
  return point.position_m.allFinite() && !point.position_m.isZero(0.0F);
}

bool IsRing(double ring) {
  return ring >= 0 && ring <= std::numeric_limits<std::uint16_t>::max() && ring == std::floor(ring);
}

bool IsReturnNumber(double number) {
  return number >= 0 && number <= std::numeric_limits<std::uint8_t>::max() &&
         number == std::floor(number);
}

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};

Range FiniteRange(const std::vector<double>& values) {
  Range range;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.least = std::min(range.least, value);
    range.most = std::max(range.most, value);
  }
  return range;
}

/// How many of the numbers make a second; nothing if a sweep lasts so long in no unit.
std::optional<double> PerSecond(const Range& range) {
  constexpr double kShortestSweepS = 0.004;
  constexpr double kLongestSweepS = 2.5;
  const double span = range.most - range.least;
  for (const double per_second : {1.0, 1e3, 1e6, 1e9}) {
    if (span >= kShortestSweepS * per_second && span <= kLongestSweepS * per_second) {
      return per_second;
    }
  }
  // A part of a sweep, in the unit that voqcal writes.
  const bool is_short = span >= 0 && span < kShortestSweepS;
  if (is_short && std::max(std::abs(range.least), std::abs(range.most)) <= kLongestSweepS)
    return 1.0;
  return std::nullopt;
}

bool IsOfSomeClock(const Range& range, double per_second) {
  constexpr double kFarS = 5.0;  // twice the longest sweep: before or after the stamp is near 0
  return std::min(std::abs(range.least), std::abs(range.most)) > kFarS * per_second;
}

double Origin(const Range& range, double per_second, std::optional<double> stamp_s) {
  constexpr double kSameClockS = 10.0;
  if (!IsOfSomeClock(range, per_second)) return 0.0;
  const bool is_stamps = stamp_s && std::abs(range.least / per_second - *stamp_s) < kSameClockS;
  return is_stamps ? *stamp_s * per_second : range.least;
}

}  // namespace

std::optional<std::size_t> FindField(const std::vector<std::string>& names,
                                     std::string_view field) {
  for (const std::string_view wanted : NamesOf(field)) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (IsSame(names[i], wanted)) return i;
    }
  }
  return std::nullopt;
}

void SetRings(const std::vector<double>& rings, PointCloud* cloud) {
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (HasReturn(cloud->points[i]) && !IsRing(rings[i])) return;
  }
  cloud->has_ring = true;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (IsRing(rings[i])) cloud->points[i].ring = static_cast<std::uint16_t>(rings[i]);
  }
}

void SetReturnNumbers(const std::vector<double>& numbers, PointCloud* cloud) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (HasReturn(cloud->points[i]) && !IsReturnNumber(numbers[i])) return;
  }
  cloud->has_return_number = true;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!IsReturnNumber(numbers[i])) continue;
    cloud->points[i].return_number = static_cast<std::uint8_t>(numbers[i]);
  }
}

void SetTimes(const std::vector<double>& times, PointCloud* cloud, std::optional<double> stamp_s) {
  const Range range = FiniteRange(times);
  const std::optional<double> per_second = PerSecond(range);
  if (!per_second) return;
  cloud->has_time = true;
  const double origin = Origin(range, *per_second, stamp_s);
  for (std::size_t i = 0; i < times.size(); ++i) {
    cloud->points[i].time_s = static_cast<float>((times[i] - origin) / *per_second);
  }
}

}  // namespace voqcal
