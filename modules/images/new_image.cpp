#include "images/new_image.hpp"

#include <stdexcept>
#include <string>

namespace voqcal {

void RequireFewPixels(std::int64_t width_px, std::int64_t height_px, std::int64_t max_pixels) {
  if (width_px * height_px <= max_pixels) return;
  throw std::runtime_error(std::to_string(width_px) + " x " + std::to_string(height_px) +
                           " px are too many");
}

cv::Mat NewImage(std::int64_t width_px, std::int64_t height_px, int type) {
  try {
    return cv::Mat(static_cast<int>(height_px), static_cast<int>(width_px), type);
  } catch (const cv::Exception&) {
    throw std::runtime_error("no memory for it");
  }
}

}  // namespace voqcal
