#include "camera_driver/genicam_pixels.hpp"

#include <algorithm>
#include <iterator>

#include <opencv2/imgproc.hpp>

namespace voqcal {
namespace {

constexpr int kAsItIs = -1;

// OpenCV names a mosaic by the pixels at (1, 1) and (1, 2), GenICam by those at (0, 0) and (0, 1).
struct PixelFormat {
  std::uint32_t code;
  const char* name;
  int type;        // of the bytes, for OpenCV
  int conversion;  // to GRAY or BGR
};
constexpr PixelFormat kFormats[] = {
    {0x02180015, "BGR8", CV_8UC3, kAsItIs},
    {0x02180014, "RGB8", CV_8UC3, cv::COLOR_RGB2BGR},
    {0x01080009, "BayerRG8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    {0x0108000B, "BayerBG8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    {0x01080008, "BayerGR8", CV_8UC1, cv::COLOR_BayerGB2BGR},
    {0x0108000A, "BayerGB8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    {0x02100032, "YUV422_8", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    {0x0210001F, "YUV422_8_UYVY", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    {0x01080001, "Mono8", CV_8UC1, kAsItIs},
};

const PixelFormat* FormatOf(std::uint32_t code) {
  const auto* const found =
      std::find_if(std::begin(kFormats), std::end(kFormats), [&](const PixelFormat& format) {
        return format.code == code;
      });
  return found == std::end(kFormats) ? nullptr : found;
}

}  // namespace

bool IsKnownPixelFormat(std::uint32_t pixel_format) { return FormatOf(pixel_format) != nullptr; }

const std::vector<std::string>& KnownPixelFormatNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const PixelFormat& format : kFormats) all.emplace_back(format.name);
    return all;
  }();
  return names;
}

std::optional<cv::Mat> PictureOf(const GenicamFrame& frame) {
  const PixelFormat* const format = FormatOf(frame.pixel_format);
  if (format == nullptr || frame.width_px <= 0 || frame.height_px <= 0) return std::nullopt;
  const auto row_bytes = static_cast<std::size_t>(frame.width_px) * CV_ELEM_SIZE(format->type);
  const std::size_t step = row_bytes + static_cast<std::size_t>(frame.row_padding_bytes);
  const auto num_rows = static_cast<std::size_t>(frame.height_px);
  if (frame.num_bytes < step * (num_rows - 1) + row_bytes) return std::nullopt;
  // OpenCV does not write to it.
  const cv::Mat borrowed(
      frame.height_px, frame.width_px, format->type, const_cast<std::uint8_t*>(frame.data), step);
  if (format->conversion == kAsItIs) return borrowed.clone();
  cv::Mat picture;
  cv::cvtColor(borrowed, picture, format->conversion);
  return picture;
}

}  // namespace voqcal
