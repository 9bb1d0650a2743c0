#include "report/oblique_view.hpp"

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
/// From its centre to its farthest corner.
constexpr double kBoardPx = 130.0;
/// What is behind the board is seen above it.
constexpr double kBoardHeightShare = 0.6;

constexpr double kAsideDeg = 35.0;
constexpr double kAboveDeg = 20.0;
/// Of the board's distance: a ceiling or a wall by the eye would cover half of the picture.
constexpr double kNearestShare = 0.5;

/// Half of what scan lines are apart, 2 degrees at most: patches of neighbours touch. Along a line
/// points are closer.
constexpr double kPatchRad = 0.019;
constexpr double kWidthShare = 0.4;

/// A picture with the depth of what is in it.
struct Canvas {
  cv::Mat colour_bgr;
  cv::Mat depth_m;
};

/// An ellipse that is nearest in its middle: where patches overlap each keeps what is nearest to
/// its own point.
struct Patch {
  Eigen::Vector2d centre_px;
  double depth_m;
  Eigen::Vector2d long_axis;  ///< Unit length.
  double half_length_px;
  double half_length_m;

  /// 1 at its edge.
  double Off(const Eigen::Vector2d& pixel_px) const {
    const Eigen::Vector2d off_px = pixel_px - centre_px;
    const double along_px = long_axis.dot(off_px);
    const double across_px = long_axis.x() * off_px.y() - long_axis.y() * off_px.x();
    return std::hypot(along_px, across_px / kWidthShare) / half_length_px;
  }
};

/// Longest across the lidar's scan lines, which are cones about its z axis.
Patch PatchOf(const Eigen::Vector3d& point_lidar_m, const ObliqueView& view, const cv::Size& size) {
  const Eigen::Vector3d ray_lidar = point_lidar_m.normalized();
  const Eigen::Vector3d across_lidar = Eigen::Vector3d::UnitZ() - ray_lidar.z() * ray_lidar;
  const Eigen::Vector3d centre_view_m = view.T_view_lidar * point_lidar_m;
  const double px_per_m = kOversampling * view.focal_px / centre_view_m.z();
  Patch patch;
  patch.centre_px = px_per_m * centre_view_m.head<2>() +
                    Eigen::Vector2d(0.5 * size.width, kBoardHeightShare * size.height);
  patch.depth_m = centre_view_m.z();
  patch.long_axis = (view.T_view_lidar.linear() * across_lidar).head<2>().normalized();
  patch.half_length_m = kPatchRad * point_lidar_m.norm();
  patch.half_length_px = px_per_m * patch.half_length_m;
  return patch;
}

void DrawPatch(const Patch& patch, const cv::Vec3b& colour_bgr, Canvas* canvas) {
  const Eigen::Array2d last_pixel_px(canvas->colour_bgr.cols - 1, canvas->colour_bgr.rows - 1);
  const Eigen::Array2d centre_px = patch.centre_px;
  const Eigen::Array2d first_px = (centre_px - patch.half_length_px).ceil().max(0);
  const Eigen::Array2d last_px = (centre_px + patch.half_length_px).floor().min(last_pixel_px);
  for (int y = static_cast<int>(first_px.y()); y <= last_px.y(); ++y) {
    for (int x = static_cast<int>(first_px.x()); x <= last_px.x(); ++x) {
      const double off = patch.Off(Eigen::Vector2d(x, y));
      const auto depth_m = static_cast<float>(patch.depth_m + off * patch.half_length_m);
      if (off > 1 || depth_m >= canvas->depth_m.at<float>(y, x)) continue;
      canvas->depth_m.at<float>(y, x) = depth_m;
      canvas->colour_bgr.at<cv::Vec3b>(y, x) = colour_bgr;
    }
  }
}

double RadiusM(const BoardPose& board_m) {
  double radius_m = 0;
  for (const Eigen::Vector3d& corner_m : board_m.corners_m) {
    radius_m = std::max(radius_m, (corner_m - board_m.centre_m).norm());
  }
  return radius_m;
}

}  // namespace

ObliqueView ObliqueViewOf(const BoardPose& board_lidar_m, const Eigen::Isometry3d& T_camera_lidar) {
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
  const double distance_m = to_eye_m.norm();
  return {T_lidar_view.inverse(),
          kBoardPx * distance_m / RadiusM(board_lidar_m),
          kNearestShare * distance_m};
}

cv::Mat DrawObliqueView(const std::vector<ColouredPoint>& points, const ObliqueView& view) {
  const cv::Size size(kOversampling * kWidthPx, kOversampling * kHeightPx);
  const cv::Scalar ground_bgr(172, 132, 100);  // unlike greys, whatever their shade
  Canvas canvas{cv::Mat(size, CV_8UC3, ground_bgr),
                cv::Mat(size, CV_32FC1, std::numeric_limits<float>::infinity())};
  for (const ColouredPoint& point : points) {
    if ((view.T_view_lidar * point.position_lidar_m).z() < view.nearest_m) continue;
    DrawPatch(PatchOf(point.position_lidar_m, view, size), point.colour_bgr, &canvas);
  }
  cv::Mat picture;
  cv::resize(canvas.colour_bgr, picture, {kWidthPx, kHeightPx}, 0, 0, cv::INTER_AREA);
  return picture;
}

}  // namespace voqcal
