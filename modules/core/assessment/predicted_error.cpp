#include "core/assessment/predicted_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/estimation/left_perturbation.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr std::array<double, 6> kRangesM = {1, 2, 5, 10, 20, 50};

struct PointError {
  double px = 0;
  double mm = 0;
};

PointError ErrorAt(const Eigen::Vector3d& point_camera_m,
                   const Eigen::Isometry3d& T_camera_lidar,
                   const Matrix6d& covariance,
                   const CameraModel& camera) {
  const PointErrorForms forms = ErrorFormsAt(point_camera_m, T_camera_lidar, camera);
  return {std::sqrt((forms.px2 * covariance).trace()),
          kMmPerM * std::sqrt((forms.m2 * covariance).trace())};
}

}  // namespace

PointErrorForms ErrorFormsAt(const Eigen::Vector3d& point_camera_m,
                             const Eigen::Isometry3d& T_camera_lidar,
                             const CameraModel& camera) {
  Matrix36d J;
  J << -Skew(point_camera_m - T_camera_lidar.translation()), Eigen::Matrix3d::Identity();
  const Eigen::Vector3d ray = point_camera_m.normalized();
  const Matrix36d J_across = J - ray * (ray.transpose() * J);
  Matrix23d J_px_point;
  ProjectWithJacobian(camera, point_camera_m, &J_px_point);
  const Eigen::Matrix<double, 2, 6> J_px = J_px_point * J;
  return {J_px.transpose() * J_px, J_across.transpose() * J_across};
}

std::vector<PredictedError> PredictErrors(const Eigen::Isometry3d& T_camera_lidar,
                                          const Matrix6d& covariance,
                                          const CameraModel& camera) {
  const double right_px = camera.width_px - 1;
  const double bottom_px = camera.height_px - 1;
  std::vector<PredictedError> errors;
  for (const double range_m : kRangesM) {
    const auto at = [&](double x_px, double y_px) -> std::optional<PointError> {
      const auto ray = camera.Unproject({x_px, y_px});
      if (!ray || !camera.IsInFront(*ray)) return std::nullopt;
      return ErrorAt(range_m * *ray, T_camera_lidar, covariance, camera);
    };
    PredictedError error;
    error.range_m = range_m;
    if (const auto centre = at(right_px / 2, bottom_px / 2)) {
      error.centre_px = centre->px;
      error.centre_mm = centre->mm;
    }
    const std::array corners = {
        at(0, 0), at(right_px, 0), at(0, bottom_px), at(right_px, bottom_px)};
    // The worst is not known where the lens model ends before a corner.
    const bool are_all_known = std::all_of(
        corners.begin(), corners.end(), [](const auto& corner) { return corner.has_value(); });
    for (const auto& corner : corners) {
      if (!are_all_known) break;
      error.corner_px = std::fmax(error.corner_px, corner->px);  // the number, not the NaN
      error.corner_mm = std::fmax(error.corner_mm, corner->mm);
    }
    errors.push_back(error);
  }
  return errors;
}

}  // namespace voqcal
