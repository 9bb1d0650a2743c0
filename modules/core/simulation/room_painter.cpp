#include "core/simulation/room_painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/simulation/light.hpp"

namespace voqcal {
namespace {

constexpr int kNumSamples = 4;         // along each side of a pixel
constexpr float kSmoothLevels = 6.0F;  // corners that differ by less are one smooth surface

constexpr double kThinLinesFromM = 3.0;  // the floor's joints are narrower than a pixel from there

struct Look {
  Eigen::Vector3f bgr = Eigen::Vector3f::Zero();
  float range_m = 0.0F;
  int surface = -1;             // blind
  bool has_thin_lines = false;  // that the pixel's corners may miss
};

class Viewer {
 public:
  Viewer(const Room& room, const Eigen::Isometry3d& T_lidar_camera)
      : room_(room), T_lidar_camera_(T_lidar_camera) {}

  Look Along(const Eigen::Vector3f& ray_camera) const {
    if (!ray_camera.allFinite()) return {};
    const Eigen::Vector3d direction =
        T_lidar_camera_.linear() * ray_camera.cast<double>().normalized();
    const RoomHit hit = room_.Cast(T_lidar_camera_.translation(), direction);
    const double light = LightAt(hit.point_lidar_m, hit.normal_lidar);
    return {static_cast<float>(255.0 * light) * RoomAlbedo(hit),
            static_cast<float>(hit.range_m),
            hit.surface,
            hit.material == Material::kFloor && hit.range_m > kThinLinesFromM};
  }

 private:
  const Room& room_;
  const Eigen::Isometry3d& T_lidar_camera_;
};

using Corners = std::array<const Look*, 4>;

bool IsSmooth(const Corners& corners) {
  for (const Look* corner : corners) {
    if (corner->has_thin_lines) return false;
    if (corner->surface != corners[0]->surface) return false;
    if ((corner->bgr - corners[0]->bgr).cwiseAbs().maxCoeff() > kSmoothLevels) return false;
  }
  return true;
}

Eigen::Vector3f MeanOfSamples(const Viewer& viewer, const PixelRays& rays, int x, int y) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int j = 0; j < kNumSamples; ++j) {
    const float v = (static_cast<float>(j) + 0.5F) / kNumSamples;
    for (int i = 0; i < kNumSamples; ++i) {
      const float u = (static_cast<float>(i) + 0.5F) / kNumSamples;
      const Eigen::Vector3f upper = (1 - u) * rays.AtCorner(x, y) + u * rays.AtCorner(x + 1, y);
      const Eigen::Vector3f lower =
          (1 - u) * rays.AtCorner(x, y + 1) + u * rays.AtCorner(x + 1, y + 1);
      sum += viewer.Along((1 - v) * upper + v * lower).bgr;
    }
  }
  return sum / static_cast<float>(kNumSamples * kNumSamples);
}

}  // namespace

RoomPicture PaintRoom(const Room& room,
                      const CameraModel& camera,
                      const PixelRays& rays,
                      const Eigen::Isometry3d& T_lidar_camera) {
  const Viewer viewer(room, T_lidar_camera);
  const auto looks_along_row = [&](int y) {
    std::vector<Look> looks;
    looks.reserve(camera.width_px + 1);
    for (int x = 0; x <= camera.width_px; ++x) looks.push_back(viewer.Along(rays.AtCorner(x, y)));
    return looks;
  };
  RoomPicture picture{cv::Mat(camera.height_px, camera.width_px, CV_32FC3),
                      cv::Mat(camera.height_px, camera.width_px, CV_32F)};
  std::vector<Look> upper = looks_along_row(0);
  for (int y = 0; y < camera.height_px; ++y) {
    const std::vector<Look> lower = looks_along_row(y + 1);
    for (int x = 0; x < camera.width_px; ++x) {
      const Corners corners{&upper[x], &upper[x + 1], &lower[x], &lower[x + 1]};
      Eigen::Vector3f bgr = Eigen::Vector3f::Zero();
      float range_m = corners[0]->range_m;
      for (const Look* corner : corners) {
        bgr += 0.25F * corner->bgr;
        range_m = std::min(range_m, corner->range_m);
      }
      if (!IsSmooth(corners)) bgr = MeanOfSamples(viewer, rays, x, y);
      picture.bgr.at<cv::Vec3f>(y, x) = {bgr[0], bgr[1], bgr[2]};
      picture.range_m.at<float>(y, x) = range_m;
    }
    upper = lower;
  }
  return picture;
}

}  // namespace voqcal
