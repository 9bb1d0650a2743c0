#include "core/simulation/pixel_rays.hpp"

#include <algorithm>
#include <limits>

namespace voqcal {
namespace {

constexpr int kStepPx = 4;

// Where along 0..length a coordinate lies on a grid whose last node is exactly at `length`.
struct Interval {
  int node = 0;
  float share = 0.0F;
};

Interval IntervalOf(int coordinate, int length, int num_intervals) {
  const double position = static_cast<double>(coordinate) * num_intervals / length;
  const int node = std::min(static_cast<int>(position), num_intervals - 1);
  return {node, static_cast<float>(position - node)};
}

}  // namespace

PixelRays::PixelRays(const CameraModel& camera)
    : width_(camera.width_px),
      rays_(static_cast<std::size_t>(camera.width_px + 1) * (camera.height_px + 1)) {
  const int columns = (camera.width_px + kStepPx - 1) / kStepPx;
  const int rows = (camera.height_px + kStepPx - 1) / kStepPx;
  std::vector<Eigen::Vector3f> nodes;
  nodes.reserve(static_cast<std::size_t>(columns + 1) * (rows + 1));
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const auto ray =
          camera.Unproject({static_cast<double>(column) * camera.width_px / columns - 0.5,
                            static_cast<double>(row) * camera.height_px / rows - 0.5});
      nodes.push_back(ray ? ray->cast<float>().eval()
                          : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    }
  }
  for (int y = 0; y <= camera.height_px; ++y) {
    const Interval v = IntervalOf(y, camera.height_px, rows);
    for (int x = 0; x <= camera.width_px; ++x) {
      const Interval u = IntervalOf(x, camera.width_px, columns);
      const Eigen::Vector3f* node = &nodes[v.node * (columns + 1) + u.node];
      const Eigen::Vector3f upper = (1 - u.share) * node[0] + u.share * node[1];
      const Eigen::Vector3f lower = (1 - u.share) * node[columns + 1] + u.share * node[columns + 2];
      rays_[y * (width_ + 1) + x] = ((1 - v.share) * upper + v.share * lower).normalized();
    }
  }
}

}  // namespace voqcal
