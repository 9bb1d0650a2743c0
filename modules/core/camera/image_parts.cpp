#include "core/camera/image_parts.hpp"

#include <algorithm>

namespace voqcal {
namespace {

std::size_t Third(double pixel_px, int size_px) {
  return static_cast<std::size_t>(
      std::clamp(static_cast<int>(3 * (pixel_px + 0.5) / size_px), 0, 2));
}

}  // namespace

const std::array<std::string, kNumImageParts>& ImagePartNames() {
  static const std::array<std::string, kNumImageParts> kNames = {"top left",
                                                                 "top",
                                                                 "top right",
                                                                 "left",
                                                                 "middle",
                                                                 "right",
                                                                 "bottom left",
                                                                 "bottom",
                                                                 "bottom right"};
  return kNames;
}

std::size_t ImagePartAt(const Eigen::Vector2d& pixel_px, const CameraModel& camera) {
  return 3 * Third(pixel_px.y(), camera.height_px) + Third(pixel_px.x(), camera.width_px);
}

}  // namespace voqcal
