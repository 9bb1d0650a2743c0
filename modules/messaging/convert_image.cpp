#include "messaging/convert_image.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "images/encoded_image.hpp"
#include "images/jpeg.hpp"
#include "images/png.hpp"
#include "messaging/message_error.hpp"
#include "messaging/sequence.hpp"

namespace voqcal {
namespace {

[[noreturn]] void Fail(const std::string& cause) { throw MessageError("image message: " + cause); }

std::string Size(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

void SetSeq(std::int64_t seq, image_t* message) {
  const std::string text = std::to_string(seq);
  image_metadata_t entry{};
  entry.key = kImageSeqKey;
  entry.value.assign(text.begin(), text.end());
  entry.n = static_cast<std::int32_t>(entry.value.size());
  message->metadata = {entry};
  message->nmetadata = 1;
}

int NumChannels(const image_t& message) { return message.pixelformat == kPixelGray ? 1 : 3; }

void RequireSize(const image_t& message) {
  if (message.width <= 0 || message.height <= 0) Fail(Size(message.width, message.height) + " px");
  if (message.size < 0 || static_cast<std::size_t>(message.size) != message.data.size()) {
    Fail("size is " + std::to_string(message.size) + " but there are " +
         std::to_string(message.data.size()) + " bytes");
  }
}

void RequireRows(const image_t& message) {
  const std::int64_t row_bytes = std::int64_t{message.width} * NumChannels(message);
  if (message.row_stride < row_bytes) {
    Fail("row_stride is " + std::to_string(message.row_stride) + " but a row has " +
         std::to_string(row_bytes) + " bytes");
  }
  const std::int64_t num_needed =
      (message.height - std::int64_t{1}) * message.row_stride + row_bytes;
  if (num_needed > message.size) {
    Fail(Size(message.width, message.height) + " px need " + std::to_string(num_needed) +
         " bytes but there are " + std::to_string(message.size));
  }
}

cv::Mat RawImage(const image_t& message) {
  const std::int64_t row_bytes = std::int64_t{message.width} * NumChannels(message);
  cv::Mat image(message.height, message.width, CV_8UC(NumChannels(message)));
  for (int row = 0; row < message.height; ++row) {
    const std::uint8_t* bytes = message.data.data() + std::int64_t{row} * message.row_stride;
    std::copy(bytes, bytes + row_bytes, image.ptr(row));
  }
  return image;
}

std::string Format(const image_t& message) {
  return message.pixelformat == kPixelPng ? "PNG" : "JPEG";
}

void RequireHeader(const image_t& message) {
  const std::string format = Format(message);
  const auto info = InspectEncodedImage(message.data);
  if (!info || info->is_jpeg != (message.pixelformat == kPixelMjpeg)) {
    Fail("the data are no " + format);
  }
  // Before decoding: a damaged header must not ask for gigabytes.
  if (info->width_px != message.width || info->height_px != message.height) {
    Fail("the " + format + " has " + Size(info->width_px, info->height_px) +
         " px, the message says " + Size(message.width, message.height));
  }
  // Told without the work of decoding, for those who pass it on.
  if (!info->has_end) Fail("the " + format + " is cut off");
}

template <typename Decode>
cv::Mat Decoded(const image_t& message, const Decode& decode) try {
  return decode(message.data);
} catch (const std::runtime_error& error) {
  Fail("the " + Format(message) + " cannot be decoded: " + error.what());
}

}  // namespace

image_t ToMessage(const cv::Mat& image, std::int64_t utime, std::int64_t seq) {
  if (image.empty() || (image.type() != CV_8UC1 && image.type() != CV_8UC3)) {
    throw std::invalid_argument("image to send: must be 8-bit with 1 or 3 channels, not empty");
  }
  image_t message{};
  message.utime = utime;
  message.width = image.cols;
  message.height = image.rows;
  message.row_stride = image.cols * image.channels();
  message.pixelformat = image.channels() == 1 ? kPixelGray : kPixelBgr;
  message.data.reserve(static_cast<std::size_t>(message.row_stride) *
                       static_cast<std::size_t>(image.rows));
  for (int row = 0; row < image.rows; ++row) {
    const std::uint8_t* bytes = image.ptr(row);
    message.data.insert(message.data.end(), bytes, bytes + message.row_stride);
  }
  message.size = static_cast<std::int32_t>(message.data.size());
  SetSeq(seq, &message);
  return message;
}

image_t EncodedToMessage(std::vector<std::uint8_t> bytes, std::int64_t utime, std::int64_t seq) {
  const auto info = InspectEncodedImage(bytes);
  if (!info) throw std::runtime_error("image to send: neither a JPEG nor a PNG");
  image_t message{};
  message.utime = utime;
  message.width = info->width_px;
  message.height = info->height_px;
  message.pixelformat = info->is_jpeg ? kPixelMjpeg : kPixelPng;
  message.size = static_cast<std::int32_t>(bytes.size());
  message.data = std::move(bytes);
  SetSeq(seq, &message);
  return message;
}

void RequireSound(const image_t& message) {
  RequireSize(message);
  switch (message.pixelformat) {
    case kPixelGray:
    case kPixelBgr:
    case kPixelRgb:
      return RequireRows(message);
    case kPixelMjpeg:
    case kPixelPng:
      return RequireHeader(message);
    default:
      Fail("pixelformat " + std::to_string(message.pixelformat) +
           " is none of GRAY, RGB, BGR, MJPEG, PNG");
  }
}

cv::Mat FromMessage(const image_t& message) {
  RequireSound(message);
  using Bytes = std::vector<std::uint8_t>;
  if (message.pixelformat == kPixelPng) return Decoded(message, DecodePng);
  if (message.pixelformat == kPixelMjpeg) {
    return Decoded(message, [](const Bytes& bytes) { return DecodeJpeg(bytes); });
  }
  cv::Mat image = RawImage(message);
  if (message.pixelformat == kPixelRgb) cv::cvtColor(image, image, cv::COLOR_RGB2BGR);
  return image;
}

cv::Mat GreyFromMessage(const image_t& message) {
  if (message.pixelformat == kPixelMjpeg) {
    RequireSound(message);
    return Decoded(message, DecodeJpegInGrey);
  }
  const cv::Mat image = FromMessage(message);
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

camera_info_t ToMessage(const CameraModel& camera, std::int64_t utime, std::int64_t seq) {
  camera_info_t message{};
  message.utime = utime;
  message.seq = seq;
  message.lens_model = ToString(camera.lens);
  message.width_px = camera.width_px;
  message.height_px = camera.height_px;
  message.fx_px = camera.fx_px;
  message.fy_px = camera.fy_px;
  message.cx_px = camera.cx_px;
  message.cy_px = camera.cy_px;
  std::copy(camera.distortion.begin(), camera.distortion.end(), message.distortion);
  return message;
}

CameraModel FromMessage(const camera_info_t& message) {
  const auto lens = LensModelFromString(message.lens_model);
  if (!lens) {
    throw MessageError("camera info message: unknown lens model '" + message.lens_model + "'");
  }
  CameraModel camera;
  camera.lens = *lens;
  camera.width_px = message.width_px;
  camera.height_px = message.height_px;
  camera.fx_px = message.fx_px;
  camera.fy_px = message.fy_px;
  camera.cx_px = message.cx_px;
  camera.cy_px = message.cy_px;
  std::copy(
      std::begin(message.distortion), std::end(message.distortion), camera.distortion.begin());
  const auto problems = camera.Problems();
  if (!problems.empty()) throw MessageError("camera info message: " + problems.front());
  return camera;
}

}  // namespace voqcal
