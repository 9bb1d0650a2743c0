#include "core/simulation/pixel_rays.hpp"

#include <limits>

namespace voqcal {

PixelRays::PixelRays(const CameraModel& camera) : width_(camera.width_px) {
  const Eigen::Vector3f none = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  rays_.reserve(static_cast<std::size_t>(camera.width_px + 1) * (camera.height_px + 1));
  for (int y = 0; y <= camera.height_px; ++y) {
    for (int x = 0; x <= camera.width_px; ++x) {
      const auto ray = camera.Unproject({x - 0.5, y - 0.5});
      rays_.push_back(ray ? ray->cast<float>().eval() : none);
    }
  }
}

}  // namespace voqcal
