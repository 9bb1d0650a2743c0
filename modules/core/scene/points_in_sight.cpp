#include "core/scene/points_in_sight.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace voqcal {
namespace {

// Scan lines of common lidars are at most 2 degrees (0.035 rad) apart.
constexpr int kReachCells = 4;
constexpr double kCellRad = 0.01;
// Five times the noise of common lidars.
constexpr double kMinNearerM = 0.1;

/// By how much a point so many cells away has to be nearer: more than a wall at 45 degrees is, as
/// both are in a corner.
float MinNearerM(int num_cells, float range_m) {
  return static_cast<float>(std::max(kMinNearerM, (num_cells + 1) * kCellRad * range_m));
}

/// How far the nearest point is in each cell of the image.
class NearestRanges {
 public:
  explicit NearestRanges(const CameraModel& camera)
      : cell_px_(std::max(1.0, camera.fx_px * kCellRad)),
        num_columns_(NumCells(camera.width_px)),
        num_rows_(NumCells(camera.height_px)),
        ranges_m_(static_cast<std::size_t>(num_columns_ * num_rows_), kEmpty) {}

  void Add(const Eigen::Vector2d& pixel_px, float range_m) {
    float& nearest_m = ranges_m_[IndexOf(CellOf(pixel_px.x()), CellOf(pixel_px.y()))];
    nearest_m = std::min(nearest_m, range_m);
  }

  /// Whether there are nearer points left and right of it, or above and below.
  bool IsHidden(const Eigen::Vector2d& pixel_px, float range_m) const {
    const int column = CellOf(pixel_px.x());
    const int row = CellOf(pixel_px.y());
    const auto is_nearer_towards = [&](int right, int down) {
      for (int i = 1; i <= kReachCells; ++i) {
        const float nearer_m = range_m - RangeAt(column + i * right, row + i * down);
        if (nearer_m > MinNearerM(i, range_m)) return true;
      }
      return false;
    };
    return (is_nearer_towards(-1, 0) && is_nearer_towards(1, 0)) ||
           (is_nearer_towards(0, -1) && is_nearer_towards(0, 1));
  }

 private:
  static constexpr float kEmpty = std::numeric_limits<float>::infinity();

  int NumCells(int size_px) const { return static_cast<int>(size_px / cell_px_) + 1; }
  int CellOf(double coordinate_px) const {
    return static_cast<int>((coordinate_px + 0.5) / cell_px_);
  }
  std::size_t IndexOf(int column, int row) const {
    return static_cast<std::size_t>(row * num_columns_ + column);
  }
  float RangeAt(int column, int row) const {
    const bool is_inside = column >= 0 && column < num_columns_ && row >= 0 && row < num_rows_;
    return is_inside ? ranges_m_[IndexOf(column, row)] : kEmpty;
  }

  double cell_px_;
  int num_columns_;
  int num_rows_;
  std::vector<float> ranges_m_;
};

std::optional<Eigen::Vector2d> PixelInImage(const Eigen::Vector3d& point_camera_m,
                                            const CameraModel& camera) {
  const auto pixel_px = camera.ProjectIfInFront<double>(point_camera_m);
  if (!pixel_px || !camera.Contains(*pixel_px)) return std::nullopt;
  return pixel_px;
}

}  // namespace

std::vector<std::optional<Eigen::Vector2d>> PixelsInSight(const PointCloud& cloud_lidar_m,
                                                          const CameraModel& camera,
                                                          const Eigen::Isometry3d& T_camera_lidar) {
  const std::size_t num = cloud_lidar_m.points.size();
  std::vector<std::optional<Eigen::Vector2d>> pixels_px(num);
  std::vector<float> ranges_m(num);
  NearestRanges nearest(camera);
  for (std::size_t i = 0; i < num; ++i) {
    const Eigen::Vector3f& position_m = cloud_lidar_m.points[i].position_m;
    if (!position_m.allFinite() || position_m.isZero()) continue;
    const Eigen::Vector3d point_camera_m = T_camera_lidar * position_m.cast<double>();
    pixels_px[i] = PixelInImage(point_camera_m, camera);
    ranges_m[i] = static_cast<float>(point_camera_m.norm());
    if (pixels_px[i]) nearest.Add(*pixels_px[i], ranges_m[i]);
  }
  for (std::size_t i = 0; i < num; ++i) {
    if (pixels_px[i] && nearest.IsHidden(*pixels_px[i], ranges_m[i])) pixels_px[i].reset();
  }
  return pixels_px;
}

std::vector<ColouredPoint> PointsInColour(const PointCloud& cloud_lidar_m,
                                          const cv::Mat& image,
                                          const CameraModel& camera,
                                          const Eigen::Isometry3d& T_camera_lidar) {
  assert(image.type() == CV_8UC3);
  const auto nearest = [](double coordinate_px, int size_px, int image_size_px) {
    const double share = (coordinate_px + 0.5) / size_px;
    return std::min(static_cast<int>(share * image_size_px), image_size_px - 1);
  };
  const auto pixels_px = PixelsInSight(cloud_lidar_m, camera, T_camera_lidar);
  std::vector<ColouredPoint> points;
  for (std::size_t i = 0; i < pixels_px.size(); ++i) {
    if (!pixels_px[i]) continue;
    const int x = nearest(pixels_px[i]->x(), camera.width_px, image.cols);
    const int y = nearest(pixels_px[i]->y(), camera.height_px, image.rows);
    points.push_back(
        {cloud_lidar_m.points[i].position_m.cast<double>(), image.at<cv::Vec3b>(y, x)});
  }
  return points;
}

}  // namespace voqcal
