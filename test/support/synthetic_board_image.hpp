#pragma once

#include <cmath>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal::test {

/// The board before a grey wall, rendered through the inverse of the lens model: each pixel is the
/// mean of 4 x 4 rays. 8-bit, 1 channel. The square next to the corner (0, 0) towards -x, -y is
/// black.
inline cv::Mat RenderBoard(const CameraModel& camera,
                           const BoardSpec& board,
                           const Eigen::Isometry3d& T_camera_board) {
  constexpr int kRaysAcross = 4;
  const Eigen::Isometry3d T_board_camera = T_camera_board.inverse();
  const auto first_corner_m = board.InnerCornersBoardM().front();
  const auto brightness = [&](const Eigen::Vector3d& ray_camera) {
    constexpr double kWall = 110;
    const Eigen::Vector3d ray = T_board_camera.linear() * ray_camera;
    const Eigen::Vector3d origin = T_board_camera.translation();
    if (!(ray.z() < 0)) return kWall;
    const Eigen::Vector3d hit = origin - ray * (origin.z() / ray.z());
    if (std::abs(hit.x()) > board.width_m / 2 || std::abs(hit.y()) > board.height_m / 2) {
      return kWall;
    }
    const int i = static_cast<int>(std::floor((hit.x() - first_corner_m.x()) / board.square_m));
    const int j = static_cast<int>(std::floor((hit.y() - first_corner_m.y()) / board.square_m));
    const bool is_pattern =
        i >= -1 && i < board.num_corners_x && j >= -1 && j < board.num_corners_y;
    return is_pattern && (i + j) % 2 == 0 ? 30.0 : 220.0;
  };
  // NaN where the lens has no ray: that is wall.
  const auto ray_of = [&](int x, int y) -> Eigen::Vector3d {
    return camera.Unproject({x, y}).value_or(Eigen::Vector3d::Constant(std::nan("")));
  };
  cv::Mat image(camera.height_px, camera.width_px, CV_8UC1);
  for (int y = 0; y < camera.height_px; ++y) {
    Eigen::Vector3d ray = ray_of(0, y);
    for (int x = 0; x < camera.width_px; ++x) {
      // Within a pixel the lens is linear: its curvature moves a ray by less than 1e-3 px.
      const Eigen::Vector3d right = ray_of(x + 1, y);
      const Eigen::Vector3d below = ray_of(x, y + 1);
      double sum = 0;
      for (int k = 0; k < kRaysAcross * kRaysAcross; ++k) {
        const double dx = (k % kRaysAcross + 0.5) / kRaysAcross - 0.5;
        const double dy = (k / kRaysAcross + 0.5) / kRaysAcross - 0.5;
        sum += brightness(ray + dx * (right - ray) + dy * (below - ray));
      }
      image.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(sum / (kRaysAcross * kRaysAcross));
      ray = right;
    }
  }
  return image;
}

}  // namespace voqcal::test
