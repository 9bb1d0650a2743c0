#include "report/overlays.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "calibrate/picture_grounds.hpp"
#include "core/units.hpp"
#include "images/jpeg.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/session_scenes.hpp"
#include "report/median_range_scene.hpp"
#include "report/oblique_view.hpp"

namespace voqcal {
namespace {

constexpr int kSubPixelBits = 4;  // cv's drawing takes fixed-point coordinates

/// The nearest whole number. What is almost beside the camera projects beyond any picture: such
/// coordinates stop where cv's drawing can still work with them.
int ToInt(double coordinate) {
  constexpr double kFarOut = 1 << 26;
  return static_cast<int>(std::lround(std::clamp(coordinate, -kFarOut, kFarOut)));
}

cv::Point ToFixed(const PictureView& view, const Eigen::Vector2d& pixel_px) {
  const Eigen::Vector2d at = view.ToPicture(pixel_px);
  return {ToInt(at.x() * (1 << kSubPixelBits)), ToInt(at.y() * (1 << kSubPixelBits))};
}

/// A point of the sweep in the image, and the colour of its range.
struct SeenPoint {
  Eigen::Vector2d pixel_px;
  cv::Vec3b colour_bgr;
};

/// Those that lie in the image.
std::vector<SeenPoint> PointsInImage(const PointCloud& cloud_lidar_m,
                                     const CameraModel& camera,
                                     const Eigen::Isometry3d& T_camera_lidar) {
  std::vector<SeenPoint> seen;
  for (const LidarPoint& point : cloud_lidar_m.points) {
    if (!point.position_m.allFinite() || point.position_m.isZero()) continue;
    const Eigen::Vector3d p_lidar_m = point.position_m.cast<double>();
    const Eigen::Vector3d p_camera_m = T_camera_lidar * p_lidar_m;
    const auto pixel_px = camera.ProjectIfInFront<double>(p_camera_m);
    if (!pixel_px || !camera.Contains(*pixel_px)) continue;
    seen.push_back({*pixel_px, RangeColourBgr(p_lidar_m.norm())});
  }
  return seen;
}

/// Each a disc with a smooth edge: thousands of them, for each of which cv::circle makes a polygon.
void DrawPoints(const std::vector<SeenPoint>& points,
                const PictureView& view,
                double radius_px,
                cv::Mat* picture) {
  const double reach_px = radius_px + 0.5;
  for (const SeenPoint& point : points) {
    const Eigen::Vector2d at = view.ToPicture(point.pixel_px);
    const int left = std::max(0, ToInt(std::ceil(at.x() - reach_px)));
    const int right = std::min(picture->cols - 1, ToInt(std::floor(at.x() + reach_px)));
    const int top = std::max(0, ToInt(std::ceil(at.y() - reach_px)));
    const int bottom = std::min(picture->rows - 1, ToInt(std::floor(at.y() + reach_px)));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const double share = std::clamp(reach_px - (at - Eigen::Vector2d(x, y)).norm(), 0.0, 1.0);
        cv::Vec3b& pixel = picture->at<cv::Vec3b>(y, x);
        pixel = share * cv::Vec3d(point.colour_bgr) + (1 - share) * cv::Vec3d(pixel);
      }
    }
  }
}

void DrawOutline(const std::vector<Eigen::Vector2d>& outline_px,
                 const PictureView& view,
                 const cv::Scalar& colour,
                 bool is_upright_cross,
                 int thickness_px,
                 cv::Mat* picture) {
  if (outline_px.empty()) return;
  for (std::size_t i = 0; i < 4; ++i) {
    cv::line(*picture,
             ToFixed(view, outline_px[i]),
             ToFixed(view, outline_px[(i + 1) % 4]),
             colour,
             thickness_px,
             cv::LINE_AA,
             kSubPixelBits);
  }
  const cv::Point centre = ToFixed(view, outline_px[4]);
  const int arm = 9 << kSubPixelBits;
  const std::array<cv::Point, 2> arms =
      is_upright_cross ? std::array<cv::Point, 2>{cv::Point(arm, 0), cv::Point(0, arm)}
                       : std::array<cv::Point, 2>{cv::Point(arm, arm), cv::Point(arm, -arm)};
  for (const cv::Point& half : arms) {
    cv::line(
        *picture, centre - half, centre + half, colour, thickness_px, cv::LINE_AA, kSubPixelBits);
  }
}

cv::Mat SceneWith(const PictureGrounds& grounds, const std::vector<SeenPoint>& points) {
  cv::Mat picture = grounds.scene.clone();
  DrawPoints(points, grounds.scene_view, 1.7, &picture);
  return picture;
}

cv::Mat BoardWith(const PictureGrounds& grounds,
                  const std::vector<SeenPoint>& points,
                  const std::vector<Eigen::Vector2d>& by_lidar_px) {
  const cv::Scalar green(80, 220, 60);
  const cv::Scalar magenta(220, 40, 240);
  if (grounds.board.empty()) return {};
  cv::Mat picture = grounds.board.clone();
  DrawPoints(points, grounds.board_view, 2.7, &picture);
  DrawOutline(by_lidar_px, grounds.board_view, magenta, false, 5, &picture);
  // Thinner and above: both are seen.
  DrawOutline(grounds.by_camera_px, grounds.board_view, green, true, 2, &picture);
  return picture;
}

// Not synced: the folder is a scratch one, and goes once the page is made.
void WritePicture(const cv::Mat& picture, const std::filesystem::path& path) {
  constexpr int kQuality = 72;
  const std::vector<std::uint8_t> jpeg = EncodeJpeg(picture, kQuality);
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(jpeg.data()), static_cast<std::streamsize>(jpeg.size()));
  file.close();
  if (!file) {
    const std::string cause = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
    throw std::runtime_error(path.string() + ": cannot be written" + cause);
  }
}

/// "folder/0012_scene.jpg"
std::filesystem::path PathOf(const std::filesystem::path& folder,
                             std::int64_t sample_id,
                             const char* kind) {
  char name[48];
  std::snprintf(name, sizeof(name), "%04lld_%s.jpg", static_cast<long long>(sample_id), kind);
  return folder / name;
}

bool IsUsed(const BoardSample& sample, const CalibrationResult& result) {
  const auto& ids = result.used_ids;
  return std::find(ids.begin(), ids.end(), sample.id) != ids.end();
}

std::vector<BoardSample> UsedOf(const std::vector<BoardSample>& samples,
                                const CalibrationResult& result) {
  std::vector<BoardSample> used;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(used), [&](const auto& sample) {
    return IsUsed(sample, result);
  });
  return used;
}

/// As a calibration may be that is wrong.
Eigen::Isometry3d Turned(const Eigen::Isometry3d& T_camera_lidar) {
  return Eigen::AngleAxisd(3.0 * kRadPerDeg, Eigen::Vector3d::UnitY()) * T_camera_lidar;
}

void WriteObliqueViews(const MedianRangeScene::Scene& scene,
                       const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar,
                       const std::filesystem::path& folder) {
  const BoardSample& sample = *scene.sample;
  const ObliqueView view = ObliqueViewOf(sample.lidar.pose, T_camera_lidar);
  const auto write = [&](const char* kind, const Eigen::Isometry3d& T_colours_lidar) {
    const auto points = PointsInColour(scene.sweep_lidar_m, scene.image, camera, T_colours_lidar);
    WritePicture(DrawObliqueView(points, view), PathOf(folder, sample.id, kind));
  };
  write("coloured", T_camera_lidar);
  write("coloured_by_turned", Turned(T_camera_lidar));
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
  return SceneWith(GroundsOf(scene.sample, scene.image, camera),
                   PointsInImage(scene.sweep_lidar_m, camera, T_camera_lidar));
}

cv::Mat DrawBoard(const PosePicture& scene,
                  const CameraModel& camera,
                  const Eigen::Isometry3d& T_camera_lidar) {
  return BoardWith(GroundsOf(scene.sample, scene.image, camera),
                   PointsInImage(scene.sweep_lidar_m, camera, T_camera_lidar),
                   OutlinePx(scene.sample.lidar.pose, T_camera_lidar, camera));
}

void WriteOverlays(const Rig& rig,
                   const OfflineRun& run,
                   const std::filesystem::path& samples_log,
                   const std::filesystem::path& folder) {
  const CalibrationResult& result = *run.assessor().result();
  std::map<std::int64_t, const BoardSample*> samples;
  const std::vector<BoardSample> all = run.SamplesAsChosen();
  for (const BoardSample& sample : all) samples[sample.id] = &sample;
  MedianRangeScene median_range(UsedOf(all, result));
  const auto is_kept = [&](const SessionScene& scene) {
    // Others were discarded later, or are of a log that was joined to this.
    const auto sample = samples.find(scene.sample_id);
    return sample != samples.end() && sample->second->utime == scene.sweep.utime;
  };
  ForEachScene(samples_log, is_kept, [&](const SessionScene& messages) {
    const BoardSample& sample = *samples.at(messages.sample_id);
    const PictureGrounds* kept = run.grounds().Of(sample);
    const PictureGrounds grounds =
        kept != nullptr ? *kept : GroundsOf(sample, FromMessage(messages.image), rig.camera);
    const PointCloud sweep_lidar_m = FromMessage(messages.sweep);
    if (IsUsed(sample, result)) median_range.Offer(sample, grounds.scene, sweep_lidar_m);
    const auto write = [&](const char* kind, const cv::Mat& picture) {
      if (!picture.empty()) WritePicture(picture, PathOf(folder, sample.id, kind));
    };
    const auto points_by = [&](const Eigen::Isometry3d& T_camera_lidar) {
      return PointsInImage(sweep_lidar_m, rig.camera, T_camera_lidar);
    };
    const auto outline_by = [&](const Eigen::Isometry3d& T_camera_lidar) {
      return OutlinePx(sample.lidar.pose, T_camera_lidar, rig.camera);
    };
    const Eigen::Isometry3d& T_before = result.averaged.T_camera_lidar;
    const Eigen::Isometry3d& T_after = result.T_camera_lidar;
    const std::vector<SeenPoint> points_after = points_by(T_after);
    write("scene", SceneWith(grounds, points_after));
    write("before", BoardWith(grounds, points_by(T_before), outline_by(T_before)));
    write("after", BoardWith(grounds, points_after, outline_by(T_after)));
  });
  if (median_range.Chosen()) {
    WriteObliqueViews(*median_range.Chosen(), rig.camera, result.T_camera_lidar, folder);
  }
}

}  // namespace voqcal
