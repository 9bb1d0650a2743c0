#include "core/scene/depth_edges.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace voqcal {
namespace {

// Returns without a ring are put on scan lines by elevation. Half the spacing of the densest
// spinning lidars, and well above the jitter of one beam.
constexpr double kLineHeightRad = 0.1 * M_PI / 180.0;

struct Return {
  double azimuth_rad;
  float range_m;
  Eigen::Vector3f position_m;
};

using ScanLine = std::vector<Return>;

// In order of azimuth.
std::map<int, ScanLine> ScanLines(const PointCloud& cloud, double min_range_m) {
  std::map<int, ScanLine> lines;
  for (const LidarPoint& point : cloud.points) {
    const Eigen::Vector3f& p = point.position_m;
    const float range_m = p.norm();
    if (!std::isfinite(range_m) || range_m < min_range_m) continue;
    const double elevation_rad = std::asin(p.z() / range_m);
    const int line =
        cloud.has_ring ? point.ring : static_cast<int>(std::floor(elevation_rad / kLineHeightRad));
    lines[line].push_back({std::atan2(p.y(), p.x()), range_m, p});
  }
  for (auto& [_, line] : lines) {
    std::sort(line.begin(), line.end(), [](const Return& a, const Return& b) {
      return a.azimuth_rad != b.azimuth_rad ? a.azimuth_rad < b.azimuth_rad : a.range_m < b.range_m;
    });
  }
  return lines;
}

// The nearer surface must go on behind its last return by a step that is small against the jump: a
// beam split between two surfaces answers from in between, and lies on none.
bool IsEdge(const Return& before, const Return& last, const Return& next, double min_jump_m) {
  const double jump_m = next.range_m - last.range_m;
  return jump_m > min_jump_m && std::abs(last.range_m - before.range_m) < 0.2 * jump_m;
}

DepthEdge EdgeBetween(const Return& last, const Return& next) {
  const Eigen::Vector3f last_ray = last.position_m / last.range_m;
  const Eigen::Vector3f next_ray = next.position_m / next.range_m;
  const Eigen::Vector3f half_way = (last_ray + next_ray).normalized();
  const Eigen::Vector3f step = next_ray - last_ray;
  DepthEdge edge;
  edge.position_lidar_m = last.range_m * half_way;
  edge.outward_lidar = (step - step.dot(half_way) * half_way).normalized();
  edge.step_rad = step.norm();
  return edge;
}

}  // namespace

std::vector<DepthEdge> FindDepthEdges(const PointCloud& cloud_lidar_m,
                                      const DepthEdgeOptions& options) {
  std::vector<DepthEdge> edges;
  const auto is_near = [&options](const Return& a, const Return& b) {
    return std::abs(a.azimuth_rad - b.azimuth_rad) < options.max_step_rad;
  };
  for (const auto& [_, line] : ScanLines(cloud_lidar_m, options.min_range_m)) {
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const Return& left = line[i - 1];
      const Return& here = line[i];
      const Return& right = line[i + 1];
      if (!is_near(left, here) || !is_near(here, right)) continue;
      if (IsEdge(left, here, right, options.min_jump_m)) {
        edges.push_back(EdgeBetween(here, right));
      } else if (IsEdge(right, here, left, options.min_jump_m)) {
        edges.push_back(EdgeBetween(here, left));
      }
    }
  }
  return edges;
}

}  // namespace voqcal
