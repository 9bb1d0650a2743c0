#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace voqcal {

/// A PNG's image, 8-bit: GRAY if the file is grey without alpha, else BGR. Alpha is left out; of
/// 16 bits the upper 8 are kept.
///
/// @throws std::runtime_error with the cause: the bytes cannot be decoded, are damaged, or have
///     more than kMaxImagePixels, or there is no memory.
cv::Mat DecodePng(const std::vector<std::uint8_t>& bytes);

}  // namespace voqcal
