#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "core/camera/camera_model.hpp"
#include "voqcal/camera_info_t.hpp"
#include "voqcal/image_t.hpp"

namespace voqcal {

/// image_t::pixelformat: FOURCC codes, bot_core's and (PNG) one more.
enum PixelFormat : std::int32_t {
  kPixelGray = 1497715271,
  kPixelRgb = 859981650,
  kPixelBgr = 861030210,
  kPixelMjpeg = 1196444237,
  kPixelPng = 541544016,
};

/// @param image  8-bit, 1 channel (sent as GRAY) or 3 (as BGR). Exact.
/// @param seq    counts up by one with each image; carried as metadata, for SequenceOf.
/// @throws std::invalid_argument for another type or an empty image.
image_t ToMessage(const cv::Mat& image, std::int64_t utime, std::int64_t seq);

/// A message of a whole JPEG or PNG file's bytes as they are; only the size is read from them.
/// @throws std::runtime_error if they are neither.
image_t EncodedToMessage(std::vector<std::uint8_t> bytes, std::int64_t utime, std::int64_t seq);

/// Whatever can be told of an image without decoding it, so that a damaged one costs no memory.
///
/// @throws MessageError with the cause: sizes that contradict each other, an unknown
///     pixelformat, data of another format, or a JPEG or PNG without its end.
void RequireSound(const image_t& message);

/// The image, 8-bit, GRAY or BGR, decoded if need be, without turning it by its EXIF orientation.
///
/// @throws MessageError with the cause: as RequireSound, or data that cannot be decoded, as
///     too large ones. (A JPEG damaged in its middle decodes to an image with wrong parts: the
///     format has no checksum.)
cv::Mat FromMessage(const image_t& message);
/// The same in GRAY, of a JPEG for less work (DecodeJpegInGrey).
cv::Mat GreyFromMessage(const image_t& message);

camera_info_t ToMessage(const CameraModel& camera, std::int64_t utime, std::int64_t seq);

/// @throws MessageError for an unknown lens model or one with Problems().
CameraModel FromMessage(const camera_info_t& message);

}  // namespace voqcal
