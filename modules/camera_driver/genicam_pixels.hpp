#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace voqcal {

/// A frame as GenICam cameras send it.
struct GenicamFrame {
  std::uint32_t pixel_format = 0;  ///< By the Pixel Format Naming Convention (EMVA).
  int width_px = 0;
  int height_px = 0;
  int row_padding_bytes = 0;
  const std::uint8_t* data = nullptr;  ///< Borrowed.
  std::size_t num_bytes = 0;
};

/// The frame as 8-bit GRAY or BGR; nothing if its format is not known here or its bytes are too
/// few.
std::optional<cv::Mat> PictureOf(const GenicamFrame& frame);

bool IsKnownPixelFormat(std::uint32_t pixel_format);

/// The names of the formats that are known here, as cameras call them, the best first.
const std::vector<std::string>& KnownPixelFormatNames();

}  // namespace voqcal
