#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/simulation/board_prop.hpp"

namespace voqcal::test {

/// How bright a printed board is where; nothing beyond its outline.
inline std::optional<double> BrightnessOf(const BoardFace& face,
                                          const Eigen::Vector2d& at_board_m) {
  constexpr double kDark = 30;
  constexpr double kBright = 220;
  const int cell = face.CellAt(at_board_m.x(), at_board_m.y());
  if (face.IsOutside(cell)) return {};
  return face.IsDark(cell) ? kDark : kBright;
}

/// Where the board may be in the image: its outline's surroundings, or all of it where the lens
/// does not say.
inline cv::Rect AreaOfBoard(const CameraModel& camera,
                            const BoardSpec& board,
                            const Eigen::Isometry3d& T_camera_board) {
  constexpr int kPointsPerEdge = 20;
  constexpr double kRimPx = 8;  // the bend of the outline between two of the points
  const cv::Rect all(0, 0, camera.width_px, camera.height_px);
  const auto outline_m = board.OutlineBoardM();
  Eigen::AlignedBox2d box;
  for (int n = 0; n < 4 * kPointsPerEdge; ++n) {
    const int edge = n / kPointsPerEdge;
    const double t = static_cast<double>(n % kPointsPerEdge) / kPointsPerEdge;
    const Eigen::Vector3d point =
        T_camera_board * ((1 - t) * outline_m[edge] + t * outline_m[(edge + 1) % 4]);
    if (!camera.IsInFront(point)) return all;
    box.extend(camera.Project(point));
  }
  const Eigen::Vector2d rim = Eigen::Vector2d::Constant(kRimPx);
  const Eigen::Vector2d size_px(camera.width_px, camera.height_px);
  const Eigen::Vector2i from =
      (box.min() - rim).cwiseMax(0).cwiseMin(size_px).array().floor().cast<int>();
  const Eigen::Vector2i to =
      (box.max() + rim).cwiseMax(0).cwiseMin(size_px).array().ceil().cast<int>();
  return cv::Rect(from.x(), from.y(), to.x() - from.x(), to.y() - from.y());
}

/// The board before a grey wall, rendered through the inverse of the lens model: each pixel is the
/// mean of `num_rays_across` squared rays. 8-bit, 1 channel.
///
/// @param brightness_at  of a point of the board's face, Eigen::Vector2d in metres; nothing beyond.
template <typename BrightnessAt>
cv::Mat RenderFace(const CameraModel& camera,
                   const BoardSpec& board,
                   const Eigen::Isometry3d& T_camera_board,
                   int num_rays_across,
                   const BrightnessAt& brightness_at) {
  constexpr double kWall = 110;
  const Eigen::Isometry3d T_board_camera = T_camera_board.inverse();
  const auto brightness = [&](const Eigen::Vector3d& ray_camera) {
    const Eigen::Vector3d ray = T_board_camera.linear() * ray_camera;
    const Eigen::Vector3d origin = T_board_camera.translation();
    if (!(ray.z() < 0)) return kWall;
    const Eigen::Vector3d hit = origin - ray * (origin.z() / ray.z());
    return brightness_at(hit.head<2>()).value_or(kWall);
  };
  // NaN where the lens has no ray: that is wall.
  const auto ray_of = [&](int x, int y) -> Eigen::Vector3d {
    return camera.Unproject({x, y}).value_or(Eigen::Vector3d::Constant(std::nan("")));
  };
  cv::Mat image(camera.height_px, camera.width_px, CV_8UC1, cv::Scalar(kWall));
  const cv::Rect area = AreaOfBoard(camera, board, T_camera_board);
  for (int y = area.y; y < area.y + area.height; ++y) {
    Eigen::Vector3d ray = ray_of(area.x, y);
    for (int x = area.x; x < area.x + area.width; ++x) {
      // Within a pixel the lens is linear: its curvature moves a ray by less than 1e-3 px.
      const Eigen::Vector3d right = ray_of(x + 1, y);
      const Eigen::Vector3d below = ray_of(x, y + 1);
      double sum = 0;
      for (int k = 0; k < num_rays_across * num_rays_across; ++k) {
        const double dx = (k % num_rays_across + 0.5) / num_rays_across - 0.5;
        const double dy = (k / num_rays_across + 0.5) / num_rays_across - 0.5;
        sum += brightness(ray + dx * (right - ray) + dy * (below - ray));
      }
      image.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(sum / (num_rays_across * num_rays_across));
      ray = right;
    }
  }
  return image;
}

/// The same of a printed board, by 4 x 4 rays. The square of a chessboard next to the corner (0, 0)
/// towards -x, -y is black.
inline cv::Mat RenderBoard(const CameraModel& camera,
                           const BoardSpec& board,
                           const Eigen::Isometry3d& T_camera_board) {
  const BoardFace face(board);
  return RenderFace(camera, board, T_camera_board, 4, [&](const Eigen::Vector2d& at_board_m) {
    return BrightnessOf(face, at_board_m);
  });
}

}  // namespace voqcal::test
