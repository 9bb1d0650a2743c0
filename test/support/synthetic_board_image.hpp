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
  const auto brightness = [&](const Eigen::Vector2d& pixel_px) {
    constexpr double kWall = 110;
    const auto ray_camera = camera.Unproject(pixel_px);
    if (!ray_camera) return kWall;
    const Eigen::Vector3d ray = T_board_camera.linear() * *ray_camera;
    const Eigen::Vector3d origin = T_board_camera.translation();
    if (ray.z() >= 0) return kWall;
    const Eigen::Vector3d hit = origin - ray * (origin.z() / ray.z());
    if (std::abs(hit.x()) > board.width_m / 2 || std::abs(hit.y()) > board.height_m / 2)
      return kWall;
    const int i = static_cast<int>(std::floor((hit.x() - first_corner_m.x()) / board.square_m));
    const int j = static_cast<int>(std::floor((hit.y() - first_corner_m.y()) / board.square_m));
    const bool is_pattern =
        i >= -1 && i < board.num_corners_x && j >= -1 && j < board.num_corners_y;
    return is_pattern && (i + j) % 2 == 0 ? 30.0 : 220.0;
  };
  cv::Mat image(camera.height_px, camera.width_px, CV_8UC1);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      double sum = 0;
      for (int k = 0; k < kRaysAcross * kRaysAcross; ++k) {
        const double dx = (k % kRaysAcross + 0.5) / kRaysAcross - 0.5;
        const double dy = (k / kRaysAcross + 0.5) / kRaysAcross - 0.5;
        sum += brightness({x + dx, y + dy});
      }
      image.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(sum / (kRaysAcross * kRaysAcross));
    }
  }
  return image;
}

}  // namespace voqcal::test
