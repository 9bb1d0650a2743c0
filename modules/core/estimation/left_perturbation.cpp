#include "core/estimation/left_perturbation.hpp"

#include <cmath>

#include <ceres/jet.h>

namespace voqcal {
namespace {

using Jet = ceres::Jet<double, 3>;

Eigen::Matrix<Jet, 3, 1> JetsOf(const Eigen::Vector3d& point_m) {
  return {Jet(point_m[0], 0), Jet(point_m[1], 1), Jet(point_m[2], 2)};
}

Eigen::Vector2d Split(const Eigen::Matrix<Jet, 2, 1>& pixel, Matrix23d* J_px_point) {
  for (int i = 0; i < 2; ++i) J_px_point->row(i) = pixel[i].v.transpose();
  return {pixel[0].a, pixel[1].a};
}

}  // namespace

Eigen::Matrix3d LeftJacobianSO3(const Eigen::Vector3d& omega_rad) {
  // The closed form given by Sola et al. 2018, "A micro Lie theory", arXiv:1812.01537.
  const double theta = omega_rad.norm();
  const Eigen::Matrix3d W = Skew(omega_rad);
  double a = 0.5;        // (1 - cos theta) / theta^2
  double b = 1.0 / 6.0;  // (theta - sin theta) / theta^3
  if (theta > 1e-4) {    // below, the series' next terms are under 1e-9 of these, times theta
    const double half_sine = std::sin(0.5 * theta);
    a = 2.0 * half_sine * half_sine / (theta * theta);
    b = (theta - std::sin(theta)) / (theta * theta * theta);
  }
  return Eigen::Matrix3d::Identity() + a * W + b * W * W;
}

LeftPerturbation::LeftPerturbation(const Eigen::Isometry3d& T_camera_lidar_start,
                                   const Vector6d& delta)
    : T_camera_lidar_(PerturbLeft(T_camera_lidar_start, delta)),
      J_left_(LeftJacobianSO3(delta.head<3>())) {}

Matrix36d LeftPerturbation::PointJacobian(const Eigen::Vector3d& point_camera_m) const {
  Matrix36d J = DirectionJacobian(point_camera_m - T_camera_lidar_.translation());
  J.rightCols<3>().setIdentity();
  return J;
}

Matrix36d LeftPerturbation::DirectionJacobian(const Eigen::Vector3d& direction_camera) const {
  Matrix36d J;
  J.leftCols<3>() = -Skew(direction_camera) * J_left_;
  J.rightCols<3>().setZero();
  return J;
}

Eigen::Vector2d ProjectWithJacobian(const CameraModel& camera,
                                    const Eigen::Vector3d& point_camera_m,
                                    Matrix23d* J_px_point) {
  if (J_px_point == nullptr) return camera.Project(point_camera_m);
  return Split(camera.Project(JetsOf(point_camera_m)), J_px_point);
}

std::optional<Eigen::Vector2d> ProjectIfInFront(const CameraModel& camera,
                                                const Eigen::Vector3d& point_camera_m,
                                                Matrix23d* J_px_point) {
  if (J_px_point == nullptr) return camera.ProjectIfInFront(point_camera_m);
  const auto pixel = camera.ProjectIfInFront(JetsOf(point_camera_m));
  if (!pixel) return std::nullopt;
  return Split(*pixel, J_px_point);
}

}  // namespace voqcal
