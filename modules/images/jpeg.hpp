#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace voqcal {

/// A JPEG's image, 8-bit, GRAY or BGR, not turned by its EXIF orientation.
///
/// @param reduction  1, 2, 4 or 8: the image at this fraction of its size, rounded up, for a
///     fraction of the work.
/// @throws std::runtime_error with the cause: the bytes cannot be decoded, have four channels
///     (CMYK), end before the image does, or have more than kMaxImagePixels (progressive ones half
///     of it and 200 scans), or there is no memory. What else libjpeg only warns of, such as data
///     damaged in their middle, gives an image with wrong parts.
cv::Mat DecodeJpeg(const std::vector<std::uint8_t>& bytes, int reduction = 1);

/// The same in GRAY: its brightness as it is in the file, without the work of making colours of it.
/// @throws as DecodeJpeg.
cv::Mat DecodeJpegInGrey(const std::vector<std::uint8_t>& bytes);

/// @param image    8-bit: GRAY, BGR or BGRA, whose alpha is left out.
/// @param quality  1 to 100. Colours have half the resolution (4:2:0).
/// @throws std::invalid_argument for another type or an empty image; std::runtime_error if it is
///     larger than a JPEG can be.
std::vector<std::uint8_t> EncodeJpeg(const cv::Mat& image, int quality);

}  // namespace voqcal
