#include "report/overlays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "files/atomic_file.hpp"
#include "images/jpeg.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/session_scenes.hpp"

namespace voqcal {
namespace {

constexpr int kSubPixelBits = 4;  // cv's drawing takes fixed-point coordinates

/// The nearest whole number. What is almost beside the camera projects beyond any picture: such
/// coordinates stop where cv's drawing can still work with them.
int ToInt(double coordinate) {
  constexpr double kFarOut = 1 << 26;
  return static_cast<int>(std::lround(std::clamp(coordinate, -kFarOut, kFarOut)));
}

/// A part of the image, scaled: pixel (0, 0) is the centre of the top-left pixel in both.
struct View {
  cv::Rect part_px;
  double scale = 1.0;

  cv::Point ToFixed(const Eigen::Vector2d& pixel_px) const {
    const double x = (pixel_px.x() - part_px.x + 0.5) * scale - 0.5;
    const double y = (pixel_px.y() - part_px.y + 0.5) * scale - 0.5;
    return {ToInt(x * (1 << kSubPixelBits)), ToInt(y * (1 << kSubPixelBits))};
  }
};

cv::Mat Cut(const cv::Mat& image, const View& view) {
  cv::Mat cut;
  const int method = view.scale < 1 ? cv::INTER_AREA : cv::INTER_CUBIC;
  cv::resize(image(view.part_px), cut, {}, view.scale, view.scale, method);
  if (cut.channels() == 1) cv::cvtColor(cut, cut, cv::COLOR_GRAY2BGR);
  return cut;
}

cv::Scalar ToScalar(const cv::Vec3b& bgr) {
  return {double(bgr[0]), double(bgr[1]), double(bgr[2])};
}

void DrawPoints(const PointCloud& cloud_lidar_m,
                const CameraModel& camera,
                const Eigen::Isometry3d& T_camera_lidar,
                const View& view,
                double radius_px,
                cv::Mat* picture) {
  const int radius = static_cast<int>(radius_px * (1 << kSubPixelBits));
  // Where a point shows: the picture and a little about it.
  const int margin = radius + (2 << kSubPixelBits);
  const cv::Rect drawn(-margin,
                       -margin,
                       (picture->cols << kSubPixelBits) + 2 * margin,
                       (picture->rows << kSubPixelBits) + 2 * margin);
  for (const LidarPoint& point : cloud_lidar_m.points) {
    if (!point.position_m.allFinite() || point.position_m.isZero()) continue;
    const Eigen::Vector3d p_lidar_m = point.position_m.cast<double>();
    const Eigen::Vector3d p_camera_m = T_camera_lidar * p_lidar_m;
    if (!camera.IsInFront(p_camera_m)) continue;
    const Eigen::Vector2d pixel_px = camera.Project<double>(p_camera_m);
    if (!camera.Contains(pixel_px)) continue;
    const cv::Point at = view.ToFixed(pixel_px);
    if (!drawn.contains(at)) continue;
    cv::circle(*picture,
               at,
               radius,
               ToScalar(RangeColourBgr(p_lidar_m.norm())),
               cv::FILLED,
               cv::LINE_AA,
               kSubPixelBits);
  }
}

/// The board's corners and centre in the image; nothing if one of them is not in front.
std::vector<Eigen::Vector2d> OutlinePx(const BoardPose& pose,
                                       const Eigen::Isometry3d& T_camera_sensor,
                                       const CameraModel& camera) {
  std::vector<Eigen::Vector3d> points_camera_m;
  for (const Eigen::Vector3d& corner_m : pose.corners_m) {
    points_camera_m.push_back(T_camera_sensor * corner_m);
  }
  points_camera_m.push_back(T_camera_sensor * pose.centre_m);
  std::vector<Eigen::Vector2d> pixels_px;
  for (const Eigen::Vector3d& point_camera_m : points_camera_m) {
    if (!camera.IsInFront(point_camera_m)) return {};
    pixels_px.push_back(camera.Project<double>(point_camera_m));
  }
  return pixels_px;
}

void DrawOutline(const std::vector<Eigen::Vector2d>& outline_px,
                 const View& view,
                 const cv::Scalar& colour,
                 bool is_upright_cross,
                 int thickness_px,
                 cv::Mat* picture) {
  if (outline_px.empty()) return;
  for (std::size_t i = 0; i < 4; ++i) {
    cv::line(*picture,
             view.ToFixed(outline_px[i]),
             view.ToFixed(outline_px[(i + 1) % 4]),
             colour,
             thickness_px,
             cv::LINE_AA,
             kSubPixelBits);
  }
  const cv::Point centre = view.ToFixed(outline_px[4]);
  const int arm = 9 << kSubPixelBits;
  const std::array<cv::Point, 2> arms =
      is_upright_cross ? std::array<cv::Point, 2>{cv::Point(arm, 0), cv::Point(0, arm)}
                       : std::array<cv::Point, 2>{cv::Point(arm, arm), cv::Point(arm, -arm)};
  for (const cv::Point& half : arms) {
    cv::line(
        *picture, centre - half, centre + half, colour, thickness_px, cv::LINE_AA, kSubPixelBits);
  }
}

/// The board with a margin, as large in the picture as `size_px` allows.
View NearView(const std::vector<Eigen::Vector2d>& outline_px, const cv::Size& image_size) {
  constexpr double kMargin = 0.25;  // of the board's size, on each side
  constexpr double kSizePx = 400;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& pixel_px : outline_px) box.extend(pixel_px);
  const double side_px = (1 + 2 * kMargin) * box.sizes().maxCoeff();
  const Eigen::Vector2d corner_px = box.center() - Eigen::Vector2d::Constant(side_px / 2);
  View view;
  view.part_px =
      cv::Rect(ToInt(corner_px.x()), ToInt(corner_px.y()), ToInt(side_px), ToInt(side_px)) &
      cv::Rect({}, image_size);
  view.scale = kSizePx / side_px;
  return view;
}

void WritePicture(const cv::Mat& picture, const std::filesystem::path& path) {
  constexpr int kQuality = 72;
  const std::vector<std::uint8_t> jpeg = EncodeJpeg(picture, kQuality);
  WriteFileAtomically(path, {reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
}

}  // namespace

cv::Vec3b RangeColourBgr(double range_m) {
  static const cv::Mat kColours = [] {
    cv::Mat levels(1, 256, CV_8UC1);
    for (int i = 0; i < 256; ++i) levels.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
    cv::Mat colours;
    cv::applyColorMap(levels, colours, cv::COLORMAP_TURBO);
    return colours;
  }();
  const double share = std::log(kFarRangeM / range_m) / std::log(kFarRangeM / kNearRangeM);
  return kColours.at<cv::Vec3b>(0,
                                static_cast<int>(std::lround(255 * std::clamp(share, 0.0, 1.0))));
}

cv::Mat DrawScene(const PosePicture& scene,
                  const CameraModel& camera,
                  const Eigen::Isometry3d& T_camera_lidar) {
  constexpr double kMaxWidthPx = 720;
  const View view{cv::Rect({}, scene.image.size()), std::min(1.0, kMaxWidthPx / scene.image.cols)};
  cv::Mat picture = Cut(scene.image, view);
  DrawPoints(scene.sweep_lidar_m, camera, T_camera_lidar, view, 1.3, &picture);
  return picture;
}

cv::Mat DrawBoard(const PosePicture& scene,
                  const CameraModel& camera,
                  const Eigen::Isometry3d& T_camera_lidar) {
  const cv::Scalar green(80, 220, 60);
  const cv::Scalar magenta(220, 40, 240);
  const auto by_camera_px =
      OutlinePx(scene.sample.camera.pose, Eigen::Isometry3d::Identity(), camera);
  if (by_camera_px.empty()) return {};
  const View view = NearView(by_camera_px, scene.image.size());
  if (view.part_px.empty()) return {};
  cv::Mat picture = Cut(scene.image, view);
  DrawPoints(scene.sweep_lidar_m, camera, T_camera_lidar, view, 2.2, &picture);
  const auto by_lidar_px = OutlinePx(scene.sample.lidar.pose, T_camera_lidar, camera);
  DrawOutline(by_lidar_px, view, magenta, false, 5, &picture);
  DrawOutline(by_camera_px, view, green, true, 2, &picture);  // thinner and above: both are seen
  return picture;
}

void WriteOverlays(const Rig& rig,
                   const OfflineRun& run,
                   const std::filesystem::path& samples_log,
                   const std::filesystem::path& folder) {
  const CalibrationResult& result = *run.assessor().result();
  std::map<std::int64_t, const BoardSample*> samples;
  const std::vector<BoardSample> all = run.SamplesAsChosen();
  for (const BoardSample& sample : all) samples[sample.id] = &sample;
  const auto is_kept = [&](const SessionScene& scene) {
    // Others were discarded later, or are of a log that was joined to this.
    const auto sample = samples.find(scene.sample_id);
    return sample != samples.end() && sample->second->utime == scene.sweep.utime;
  };
  ForEachScene(samples_log, is_kept, [&](const SessionScene& messages) {
    const cv::Mat image = FromMessage(messages.image);
    const PointCloud sweep_lidar_m = FromMessage(messages.sweep);
    const PosePicture scene{*samples.at(messages.sample_id), image, sweep_lidar_m};
    char id[24];
    std::snprintf(id, sizeof(id), "%04lld", static_cast<long long>(messages.sample_id));
    const auto write = [&](const char* kind, const cv::Mat& picture) {
      if (!picture.empty()) WritePicture(picture, folder / (std::string(id) + kind + ".jpg"));
    };
    write("_scene", DrawScene(scene, rig.camera, result.T_camera_lidar));
    write("_before", DrawBoard(scene, rig.camera, result.averaged.T_camera_lidar));
    write("_after", DrawBoard(scene, rig.camera, result.T_camera_lidar));
  });
}

}  // namespace voqcal
