#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

using Matrix36d = Eigen::Matrix<double, 3, 6>;
using Matrix23d = Eigen::Matrix<double, 2, 3>;

/// The left Jacobian of SO(3): ExpSO3(w + d) ~ ExpSO3(LeftJacobianSO3(w) d) ExpSO3(w).
Eigen::Matrix3d LeftJacobianSO3(const Eigen::Vector3d& omega_rad);

/// A transform as a function of six parameters about a start, and how points and directions move:
///     T(delta) = PerturbLeft(T_start, delta)
/// The rotation's chart is regular up to |delta_r| = 2 pi, so a plain 6-vector serves the solvers.
class LeftPerturbation {
 public:
  LeftPerturbation(const Eigen::Isometry3d& T_camera_lidar_start, const Vector6d& delta);

  const Eigen::Isometry3d& T_camera_lidar() const { return T_camera_lidar_; }

  /// d (R p + t) / d delta, given p_camera = R p + t.
  Matrix36d PointJacobian(const Eigen::Vector3d& point_camera_m) const;
  /// d (R n) / d delta, given n_camera = R n.
  Matrix36d DirectionJacobian(const Eigen::Vector3d& direction_camera) const;

 private:
  Eigen::Isometry3d T_camera_lidar_;
  Eigen::Matrix3d J_left_;
};

/// The pixel of a point ahead of the camera, and its derivative by the point unless `J` is null.
Eigen::Vector2d ProjectWithJacobian(const CameraModel& camera,
                                    const Eigen::Vector3d& point_camera_m,
                                    Matrix23d* J_px_point);

/// The same where the point is in front of the camera (IsInFront), for less than both; nothing
/// elsewhere.
std::optional<Eigen::Vector2d> ProjectIfInFront(const CameraModel& camera,
                                                const Eigen::Vector3d& point_camera_m,
                                                Matrix23d* J_px_point);

}  // namespace voqcal
