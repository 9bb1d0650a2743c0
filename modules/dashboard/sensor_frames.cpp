#include "dashboard/sensor_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "core/scene/points_in_sight.hpp"
#include "images/jpeg.hpp"
#include "messaging/convert_image.hpp"

namespace voqcal {
namespace {

using Json = nlohmann::json;

constexpr int kJpegQuality = 75;
constexpr std::int16_t kNotSeen = std::numeric_limits<std::int16_t>::min();

/// By how much an image of this width is made smaller: 1, 2, 4 or 8, as JPEG decoders can.
int Reduction(int width_px, int max_width_px) {
  int factor = 1;
  while (factor < 8 && width_px > factor * max_width_px) factor *= 2;
  return factor;
}

/// At least a pixel high, however flat the image is.
cv::Mat Small(const image_t& image, int factor) {
  if (image.pixelformat == kPixelMjpeg && factor > 1) return DecodeJpeg(image.data, factor);
  const cv::Mat whole = FromMessage(image);
  if (factor == 1) return whole;
  const cv::Size size(std::max(whole.cols / factor, 1), std::max(whole.rows / factor, 1));
  cv::Mat small;
  cv::resize(whole, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

/// Every point with a return, or a part of them that no scan pattern of the lidar can favour: the
/// multiples of the golden ratio spread evenly over [0, 1), and so do any of their subsequences by
/// equal steps.
/// @return which.
std::vector<std::size_t> Thinned(const PointCloud& cloud_lidar_m, int max_points) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double share = static_cast<double>(max_points) /
                       static_cast<double>(std::max<std::size_t>(cloud_lidar_m.points.size(), 1));
  std::vector<std::size_t> thinned;
  double phase = 0;
  for (std::size_t i = 0; i < cloud_lidar_m.points.size(); ++i) {
    phase += kGoldenRatio;
    if (phase >= 1) phase -= 1;
    if (phase >= share) continue;
    const Eigen::Vector3f& position_m = cloud_lidar_m.points[i].position_m;
    if (!position_m.allFinite() || position_m.isZero()) continue;
    thinned.push_back(i);
  }
  return thinned;
}

void AppendInt16(double value, std::string* bytes) {
  const auto number = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(value)));
  *bytes += static_cast<char>(number & 0xffU);
  *bytes += static_cast<char>(number >> 8U);
}

/// Metres to a unit of int16, such that the farthest point fits.
double ScaleOf(const PointCloud& cloud_lidar_m, const std::vector<std::size_t>& shown) {
  float farthest_m = 1.0F;
  for (const std::size_t i : shown) {
    farthest_m = std::max(farthest_m, cloud_lidar_m.points[i].position_m.cwiseAbs().maxCoeff());
  }
  return static_cast<double>(farthest_m) / std::numeric_limits<std::int16_t>::max();
}

void AppendPixel(const std::optional<Eigen::Vector2d>& pixel_px, std::string* bytes) {
  AppendInt16(pixel_px ? pixel_px->x() : kNotSeen, bytes);
  AppendInt16(pixel_px ? pixel_px->y() : kNotSeen, bytes);
}

}  // namespace

PageImage ForPage(const image_t& image, const DashboardOptions& options) {
  RequireSound(image);
  PageImage made{image.utime, image.width, image.height, "image/jpeg", ""};
  const bool is_jpeg = image.pixelformat == kPixelMjpeg;
  const int factor = Reduction(image.width, options.max_image_width_px);
  if (factor == 1 && (is_jpeg || image.pixelformat == kPixelPng)) {
    if (!is_jpeg) made.type = "image/png";
    made.bytes.assign(image.data.begin(), image.data.end());
  } else {
    const std::vector<std::uint8_t> jpeg = EncodeJpeg(Small(image, factor), kJpegQuality);
    made.bytes.assign(jpeg.begin(), jpeg.end());
  }
  return made;
}

FramePtr ImageFrame(const PageImage& image, const std::string& board_json) {
  const Json header = {{"kind", ToString(Slot::kImage)},
                       {"utime", image.utime},
                       {"width", image.width_px},
                       {"height", image.height_px},
                       {"type", image.type},
                       {"board", board_json.empty() ? Json() : Json::parse(board_json)}};
  return BinaryFrame(header.dump(), image.bytes);
}

FramePtr CloudFrame(const PointCloud& cloud_lidar_m,
                    std::int64_t utime,
                    const std::optional<Eigen::Isometry3d>& T_camera_lidar,
                    const CameraModel& camera,
                    const DashboardOptions& options) {
  const std::vector<std::size_t> shown = Thinned(cloud_lidar_m, options.max_cloud_points);
  const double scale_m = ScaleOf(cloud_lidar_m, shown);
  std::string payload;
  for (const std::size_t i : shown) {
    for (const float coordinate_m : cloud_lidar_m.points[i].position_m) {
      AppendInt16(static_cast<double>(coordinate_m) / scale_m, &payload);
    }
  }
  if (T_camera_lidar) {
    const auto pixels_px = PixelsInSight(cloud_lidar_m, camera, *T_camera_lidar);
    for (const std::size_t i : shown) AppendPixel(pixels_px[i], &payload);
  }
  const Json header = {{"kind", ToString(Slot::kCloud)},
                       {"utime", utime},
                       {"num_points", shown.size()},
                       {"scale_m", scale_m},
                       {"has_pixels", T_camera_lidar.has_value()}};
  return BinaryFrame(header.dump(), payload);
}

}  // namespace voqcal
