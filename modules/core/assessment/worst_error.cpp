#include "core/assessment/worst_error.hpp"

#include <cmath>
#include <stdexcept>

#include "core/assessment/predicted_error.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

constexpr double kSquareMillimetres = 1e6;  // in a square metre
// Errors vary smoothly, and are largest towards the borders, which the grid includes.
constexpr int kNumColumns = 5;
constexpr int kNumRows = 5;

}  // namespace

std::string ToString(ErrorUnit unit) { return unit == ErrorUnit::kMillimetres ? "mm" : "px"; }

std::vector<std::string> ErrorTolerance::Problems() const {
  ProblemList problems;
  problems.Require(
      tolerance > 0.0 && std::isfinite(tolerance), "tolerance must be positive", tolerance);
  problems.RequirePositive("min_range_m", min_range_m);
  problems.Require(max_range_m >= min_range_m && std::isfinite(max_range_m),
                   "max_range_m must be at least min_range_m",
                   max_range_m);
  return problems.lines();
}

ErrorScene::ErrorScene(const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar,
                       const ErrorTolerance& tolerance) {
  RequireUsable("ErrorTolerance", tolerance.Problems());
  for (int row = 0; row < kNumRows; ++row) {
    for (int column = 0; column < kNumColumns; ++column) {
      const Eigen::Vector2d pixel_px((camera.width_px - 1.0) * column / (kNumColumns - 1),
                                     (camera.height_px - 1.0) * row / (kNumRows - 1));
      const auto ray = camera.Unproject(pixel_px);
      if (!ray || !camera.IsInFront(*ray)) continue;  // beyond what the lens model can say
      for (const double range_m : {tolerance.min_range_m, tolerance.max_range_m}) {
        const Eigen::Vector3d point_camera_m = range_m * *ray;
        const PointErrorForms forms = ErrorFormsAt(point_camera_m, T_camera_lidar, camera);
        const bool is_mm = tolerance.unit == ErrorUnit::kMillimetres;
        points_.push_back({is_mm ? Matrix6d(kSquareMillimetres * forms.m2) : forms.px2,
                           {0.0, range_m, pixel_px, point_camera_m}});
      }
    }
  }
  if (points_.empty()) throw std::invalid_argument("ErrorScene: no pixel of the camera has a ray");
}

WorstError ErrorScene::Worst(const Matrix6d& covariance) const {
  const Point* worst = &points_.front();
  double largest_square = -1.0;
  for (const Point& point : points_) {
    // The trace of a product of symmetric matrices.
    const double square = point.form.cwiseProduct(covariance).sum();
    if (square > largest_square) {
      largest_square = square;
      worst = &point;
    }
  }
  WorstError error = worst->at;
  error.error = std::sqrt(largest_square);
  return error;
}

std::vector<Matrix6d> ErrorScene::Forms() const {
  std::vector<Matrix6d> forms;
  for (const Point& point : points_) forms.push_back(point.form);
  return forms;
}

}  // namespace voqcal
