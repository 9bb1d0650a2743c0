#pragma once

#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// How far a lidar point is expected to land from where the camera sees it, by the extrinsic's
/// covariance alone: root mean square, across the camera's ray. NaN where the lens model ends
/// before the point.
struct PredictedError {
  double range_m = 0;                                           ///< Of the point from the camera.
  double centre_px = std::numeric_limits<double>::quiet_NaN();  ///< In the middle of the image...
  double centre_mm = std::numeric_limits<double>::quiet_NaN();
  double corner_px = std::numeric_limits<double>::quiet_NaN();  ///< ...and in its worst corner.
  double corner_mm = std::numeric_limits<double>::quiet_NaN();
};

/// Quadratic forms of the error at one point: trace(form * covariance) is its mean square.
struct PointErrorForms {
  Matrix6d px2 = Matrix6d::Zero();  ///< In the image.
  Matrix6d m2 = Matrix6d::Zero();   ///< Across the camera's ray.
};

/// A point p = R q + t of the camera frame moves by d = r x (p - t) + dt when [r; dt] perturbs the
/// extrinsic, so that its covariance is J C J' with J = [-[p - t]x, I], and the forms are J' P' P J
/// with P the part across the ray, or the projection's derivative.
/// @param point_camera_m  in front of the camera.
PointErrorForms ErrorFormsAt(const Eigen::Vector3d& point_camera_m,
                             const Eigen::Isometry3d& T_camera_lidar,
                             const CameraModel& camera);

/// At 1, 2, 5, 10, 20 and 50 m.
/// @param covariance  of [rotation_rad; translation_m] of T_camera_lidar, left (camera) side.
std::vector<PredictedError> PredictErrors(const Eigen::Isometry3d& T_camera_lidar,
                                          const Matrix6d& covariance,
                                          const CameraModel& camera);

}  // namespace voqcal
