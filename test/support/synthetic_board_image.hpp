#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera_detection/charuco_corners.hpp"

namespace voqcal::test {

/// The printed face of a board: how bright it is where.
class PrintedFace {
 public:
  explicit PrintedFace(const BoardSpec& board)
      : board_(board), first_corner_m_(board.InnerCornersBoardM().front().head<2>()) {
    if (board.pattern == "charuco") charuco_ = DrawCharuco(board, kPixelsPerSquare);
  }

  /// Nothing beyond the outline.
  std::optional<double> BrightnessAt(const Eigen::Vector2d& at_board_m) const {
    if (std::abs(at_board_m.x()) > board_.width_m / 2) return {};
    if (std::abs(at_board_m.y()) > board_.height_m / 2) return {};
    // In squares from the pattern's lower left corner.
    const Eigen::Vector2d at =
        (at_board_m - first_corner_m_) / board_.square_m + Eigen::Vector2d::Ones();
    const int num_x = board_.num_corners_x + 1;
    const int num_y = board_.num_corners_y + 1;
    const bool is_pattern = at.x() >= 0 && at.y() >= 0 && at.x() < num_x && at.y() < num_y;
    if (!is_pattern) return kBright;
    if (!charuco_.empty()) {
      const auto x = static_cast<int>(at.x() * kPixelsPerSquare);
      const auto y = static_cast<int>((num_y - at.y()) * kPixelsPerSquare);
      const bool is_dark = charuco_.at<unsigned char>(std::min(y, charuco_.rows - 1), x) < 128;
      return is_dark ? kDark : kBright;
    }
    return (static_cast<int>(at.x()) + static_cast<int>(at.y())) % 2 == 0 ? kDark : kBright;
  }

 private:
  static constexpr double kDark = 30;
  static constexpr double kBright = 220;
  static constexpr int kPixelsPerSquare = 140;  // a multiple of 7 cells, and of 10 to a square

  BoardSpec board_;
  Eigen::Vector2d first_corner_m_;
  cv::Mat charuco_;
};

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

/// The same of a printed chessboard or ChArUco board, by 4 x 4 rays. The square of a chessboard
/// next to the corner (0, 0) towards -x, -y is black.
inline cv::Mat RenderBoard(const CameraModel& camera,
                           const BoardSpec& board,
                           const Eigen::Isometry3d& T_camera_board) {
  const PrintedFace face(board);
  return RenderFace(camera, board, T_camera_board, 4, [&](const Eigen::Vector2d& at_board_m) {
    return face.BrightnessAt(at_board_m);
  });
}

}  // namespace voqcal::test
