#include "report/side_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr int kWidthPx = 720;
constexpr int kHeightPx = 450;
constexpr int kOversampling = 2;
constexpr double kFocalPx = 640.0;
/// What is behind the board is seen above it.
constexpr double kBoardHeightShare = 0.6;

constexpr double kAsideDeg = 35.0;
constexpr double kAboveDeg = 20.0;

/// Half of what scan lines are apart, 2 degrees at most: patches of neighbours touch. Along a line
/// points are closer.
constexpr double kPatchRad = 0.019;
constexpr double kWidthShare = 0.4;
constexpr double kNearestM = 0.3;

/// A picture with the depth of what is in it.
struct Canvas {
  cv::Mat colour_bgr;
  cv::Mat depth_m;
};

/// An upright ellipse that is nearest in its middle: where patches overlap each keeps what is
/// nearest to its own point.
void DrawPatch(const Eigen::Vector3d& centre_view_m,
               double half_height_m,
               const cv::Vec3b& colour_bgr,
               Canvas* canvas) {
  const double focal_px = kOversampling * kFocalPx;
  const double px_per_m = focal_px / centre_view_m.z();
  const Eigen::Array2d size_px(canvas->colour_bgr.cols, canvas->colour_bgr.rows);
  const Eigen::Array2d board_px = size_px * Eigen::Array2d(0.5, kBoardHeightShare);
  const Eigen::Array2d at_px = px_per_m * centre_view_m.head<2>().array() + board_px;
  const Eigen::Array2d half_m = half_height_m * Eigen::Array2d(kWidthShare, 1);
  const Eigen::Array2d first_px = (at_px - px_per_m * half_m).ceil().max(0);
  const Eigen::Array2d last_px = (at_px + px_per_m * half_m).floor().min(size_px - 1);
  for (int y = static_cast<int>(first_px.y()); y <= last_px.y(); ++y) {
    for (int x = static_cast<int>(first_px.x()); x <= last_px.x(); ++x) {
      const double off = ((Eigen::Array2d(x, y) - at_px) / (px_per_m * half_m)).matrix().norm();
      const auto depth_m = static_cast<float>(centre_view_m.z() + off * half_height_m);
      if (off > 1 || depth_m >= canvas->depth_m.at<float>(y, x)) continue;
      canvas->depth_m.at<float>(y, x) = depth_m;
      canvas->colour_bgr.at<cv::Vec3b>(y, x) = colour_bgr;
    }
  }
}

}  // namespace

Eigen::Isometry3d SideViewFromLidar(const BoardPose& board_lidar_m,
                                    const Eigen::Isometry3d& T_camera_lidar) {
  const Eigen::Isometry3d T_lidar_camera = T_camera_lidar.inverse();
  const Eigen::Vector3d up_lidar = -T_lidar_camera.linear().col(1);
  const Eigen::Vector3d to_camera_m = T_lidar_camera.translation() - board_lidar_m.centre_m;
  const Eigen::Vector3d right_lidar = T_lidar_camera.linear().col(0);
  const double side = board_lidar_m.normal.dot(right_lidar) > 0 ? 1.0 : -1.0;
  const Eigen::Vector3d to_eye_m = Eigen::AngleAxisd(side * kAsideDeg * kRadPerDeg, up_lidar) *
                                   Eigen::AngleAxisd(-kAboveDeg * kRadPerDeg, right_lidar) *
                                   to_camera_m;
  Eigen::Isometry3d T_lidar_view;
  T_lidar_view.translation() = board_lidar_m.centre_m + to_eye_m;
  T_lidar_view.linear().col(2) = -to_eye_m.normalized();
  T_lidar_view.linear().col(0) = (-to_eye_m).cross(up_lidar).normalized();
  T_lidar_view.linear().col(1) = T_lidar_view.linear().col(2).cross(T_lidar_view.linear().col(0));
  return T_lidar_view.inverse();
}

cv::Mat DrawSideView(const std::vector<ColouredPoint>& points,
                     const Eigen::Isometry3d& T_view_lidar) {
  const cv::Size size(kOversampling * kWidthPx, kOversampling * kHeightPx);
  const cv::Scalar ground_bgr(172, 132, 100);  // unlike greys, whatever their shade
  Canvas canvas{cv::Mat(size, CV_8UC3, ground_bgr),
                cv::Mat(size, CV_32FC1, std::numeric_limits<float>::infinity())};
  for (const ColouredPoint& point : points) {
    const Eigen::Vector3d centre_view_m = T_view_lidar * point.position_lidar_m;
    if (centre_view_m.z() < kNearestM) continue;
    DrawPatch(centre_view_m, kPatchRad * point.position_lidar_m.norm(), point.colour_bgr, &canvas);
  }
  cv::Mat picture;
  cv::resize(canvas.colour_bgr, picture, {kWidthPx, kHeightPx}, 0, 0, cv::INTER_AREA);
  return picture;
}

}  // namespace voqcal
