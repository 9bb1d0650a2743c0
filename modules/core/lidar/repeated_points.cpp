#include "core/lidar/repeated_points.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace voqcal {
namespace {

std::uint32_t HashOf(const Eigen::Vector3f& position_m) {
  std::array<std::uint32_t, 3> words{};
  static_assert(sizeof words == sizeof position_m);
  std::memcpy(words.data(), position_m.data(), sizeof words);
  std::uint32_t hash = 0;
  for (const std::uint32_t word : words) hash = (hash ^ word) * 0x9E3779B1U;
  return hash ^ hash >> 15;
}

}  // namespace

std::size_t DropRepeatedPoints(PointCloud* cloud) {
  std::vector<LidarPoint>& points = cloud->points;
  std::size_t num_slots = 1024;
  while (num_slots < 2 * points.size()) num_slots *= 2;
  // Of each slot, one more than the number of the point that took it: 0 is free.
  std::vector<std::uint32_t> slots(num_slots, 0);
  std::size_t num_kept = 0;
  for (const LidarPoint& point : points) {
    bool is_new = true;
    const bool is_return = point.position_m.allFinite() && !point.position_m.isZero(0.0F);
    std::size_t slot = is_return ? HashOf(point.position_m) & (num_slots - 1) : 0;
    while (is_return && slots[slot] != 0) {
      is_new = points[slots[slot] - 1].position_m != point.position_m;
      if (!is_new) break;
      slot = (slot + 1) & (num_slots - 1);
    }
    if (!is_new) continue;
    points[num_kept++] = point;
    if (is_return) slots[slot] = static_cast<std::uint32_t>(num_kept);
  }
  const std::size_t num_dropped = points.size() - num_kept;
  points.resize(num_kept);
  return num_dropped;
}

}  // namespace voqcal
