#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace voqcal {

/// What the first bytes of an encoded image say, without decoding it.
struct EncodedImageInfo {
  bool is_jpeg = false;  ///< Otherwise PNG.
  int width_px = 0;
  int height_px = 0;
  bool has_end = false;  ///< The end marker (EOI, IEND) is there: the file is not cut off.
};

/// Nothing if the bytes are neither a JPEG nor a PNG file, or end before the size.
std::optional<EncodedImageInfo> InspectEncodedImage(const std::vector<std::uint8_t>& bytes);

}  // namespace voqcal
