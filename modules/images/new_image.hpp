#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace voqcal {

/// More are not decoded: 400 MB; no camera has as many.
constexpr std::int64_t kMaxImagePixels = 1 << 27;

/// @throws std::runtime_error naming the size, if it has more than `max_pixels`.
void RequireFewPixels(std::int64_t width_px, std::int64_t height_px, std::int64_t max_pixels);

/// An image to decode into.
///
/// @param type  as OpenCV has it.
/// @throws std::runtime_error if there is no memory for it.
cv::Mat NewImage(std::int64_t width_px, std::int64_t height_px, int type);

}  // namespace voqcal
