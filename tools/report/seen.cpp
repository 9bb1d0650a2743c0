#include "report/seen.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "core/units.hpp"
#include "report/overlays.hpp"

namespace voqcal {
namespace {

const cv::Scalar kGreen(80, 220, 60);
const cv::Scalar kMagenta(220, 40, 240);

/// As seen from the lidar, rad: to the left of its x axis, and up.
struct Direction {
  double azimuth = 0.0;
  double elevation = 0.0;
};

Direction DirectionOf(const Eigen::Vector3d& point_m) {
  return {std::atan2(point_m.y(), point_m.x()),
          std::atan2(point_m.z(), std::hypot(point_m.x(), point_m.y()))};
}

/// Which directions a picture shows, and how large.
struct Window {
  Direction centre;
  double width_rad = 2 * M_PI;
  double height_rad = M_PI;
  double px_per_rad_across = 1.0;
  double px_per_rad_up = 1.0;

  cv::Size Size() const {
    return {std::max(1, static_cast<int>(std::lround(width_rad * px_per_rad_across))),
            std::max(1, static_cast<int>(std::lround(height_rad * px_per_rad_up)))};
  }
  cv::Point2d ToPx(const Direction& at) const {
    const double left = std::remainder(at.azimuth - centre.azimuth, 2 * M_PI);
    const double up = at.elevation - centre.elevation;
    return {(width_rad / 2 - left) * px_per_rad_across, (height_rad / 2 - up) * px_per_rad_up};
  }
};

bool IsReturn(const LidarPoint& point) {
  return point.position_m.allFinite() && !point.position_m.isZero();
}

/// Where nearly all returns lie: strays make no picture small.
std::pair<double, double> Extent(std::vector<double> values) {
  if (values.empty()) return {-0.1, 0.1};
  std::sort(values.begin(), values.end());
  const auto at = [&values](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.002), at(0.998)};
}

Window WholeWindow(const PointCloud& sweep_lidar_m) {
  constexpr double kWidthPx = 1080;
  constexpr double kMinHeightPx = 200;
  constexpr double kMaxStretch = 3.0;  // few lines far apart would be hard to see
  constexpr double kAllAroundRad = 5.0;
  std::vector<double> azimuths;
  std::vector<double> elevations;
  for (const LidarPoint& point : sweep_lidar_m.points) {
    if (!IsReturn(point)) continue;
    const Direction at = DirectionOf(point.position_m.cast<double>());
    azimuths.push_back(at.azimuth);
    elevations.push_back(at.elevation);
  }
  const auto [right, left] = Extent(azimuths);
  const auto [low, high] = Extent(elevations);
  Window window;
  const double margin = 1.5 / kDegPerRad;
  window.height_rad = high - low + 2 * margin;
  window.centre.elevation = (low + high) / 2;
  if (left - right < kAllAroundRad) {
    window.width_rad = left - right + 2 * margin;
    window.centre.azimuth = (left + right) / 2;
  }
  window.px_per_rad_across = kWidthPx / window.width_rad;
  const double height_px = window.height_rad * window.px_per_rad_across;
  window.px_per_rad_up =
      window.px_per_rad_across * std::clamp(kMinHeightPx / height_px, 1.0, kMaxStretch);
  return window;
}

Window NearWindow(const BoardPose& board_lidar) {
  constexpr double kSizePx = 360;
  constexpr double kMargin = 0.6;  // of the board's size, on each side
  Window window;
  window.centre = DirectionOf(board_lidar.centre_m);
  double half_rad = 0.01;
  for (const Eigen::Vector3d& corner_m : board_lidar.corners_m) {
    const Direction at = DirectionOf(corner_m);
    const double left = std::remainder(at.azimuth - window.centre.azimuth, 2 * M_PI);
    half_rad =
        std::max({half_rad, std::abs(left), std::abs(at.elevation - window.centre.elevation)});
  }
  window.width_rad = window.height_rad = 2 * (1 + kMargin) * half_rad;
  window.px_per_rad_across = window.px_per_rad_up = kSizePx / window.width_rad;
  return window;
}

void DrawOutline(const std::vector<cv::Point2d>& corners_px,
                 const cv::Scalar& colour,
                 cv::Mat* picture) {
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    const cv::Point2d& next = corners_px[(i + 1) % corners_px.size()];
    cv::line(*picture, corners_px[i], next, colour, 2, cv::LINE_AA);
  }
}

cv::Mat Draw(const PointCloud& sweep_lidar_m,
             const Window& window,
             int radius_px,
             const std::optional<BoardPose>& board_lidar) {
  cv::Mat picture(window.Size(), CV_8UC3, cv::Scalar(24, 20, 18));
  const cv::Rect2d frame(0, 0, picture.cols, picture.rows);
  for (const LidarPoint& point : sweep_lidar_m.points) {
    if (!IsReturn(point)) continue;
    const Eigen::Vector3d p_lidar_m = point.position_m.cast<double>();
    const cv::Point2d at = window.ToPx(DirectionOf(p_lidar_m));
    if (!frame.contains(at)) continue;
    const cv::Vec3b colour = RangeColourBgr(p_lidar_m.norm());
    cv::circle(picture, at, radius_px, cv::Scalar(colour), cv::FILLED, cv::LINE_AA);
  }
  if (!board_lidar) return picture;
  std::vector<cv::Point2d> corners_px;
  for (const Eigen::Vector3d& corner_m : board_lidar->corners_m) {
    if (!corner_m.allFinite()) return picture;
    corners_px.push_back(window.ToPx(DirectionOf(corner_m)));
  }
  DrawOutline(corners_px, kMagenta, &picture);
  return picture;
}

}  // namespace

cv::Mat DrawImage(const cv::Mat& image,
                  const std::optional<BoardPose>& board_camera,
                  const CameraModel& camera) {
  constexpr double kMaxWidthPx = 720;
  const double scale = std::min(1.0, kMaxWidthPx / image.cols);
  cv::Mat picture;
  cv::resize(image, picture, {}, scale, scale, cv::INTER_AREA);
  if (picture.channels() == 1) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  if (!board_camera) return picture;
  std::vector<cv::Point2d> corners_px;
  for (const Eigen::Vector3d& corner_m : board_camera->corners_m) {
    if (!corner_m.allFinite() || !camera.IsInFront(corner_m)) return picture;
    const Eigen::Vector2d pixel_px = scale * camera.Project<double>(corner_m);
    corners_px.emplace_back(pixel_px.x(), pixel_px.y());
  }
  DrawOutline(corners_px, kGreen, &picture);
  return picture;
}

cv::Mat DrawSweep(const PointCloud& sweep_lidar_m, const std::optional<BoardPose>& board_lidar) {
  return Draw(sweep_lidar_m, WholeWindow(sweep_lidar_m), 1, board_lidar);
}

cv::Mat DrawSweepNear(const PointCloud& sweep_lidar_m, const BoardPose& board_lidar) {
  return Draw(sweep_lidar_m, NearWindow(board_lidar), 3, board_lidar);
}

}  // namespace voqcal
