#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// Where a camera sees a plane with known points.
struct PlanarPose {
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (camera) side: s^2 (J'J)^-1, where s^2
  /// is the residuals' variance, sum of squares / (2 N - 6); plus p d d' of the mirrored pose: its
  /// probability and its difference from this one.
  Matrix6d covariance = Matrix6d::Zero();
  double reprojection_rms_px = std::numeric_limits<double>::quiet_NaN();
  /// Probability p of the mirrored pose: far away, a plane tilted the other way looks nearly the
  /// same. 0 if it is no other pose than this one.
  double mirrored_probability = 0.0;
};

/// The pose with the least sum of squared pixel errors, through the true lens model; nothing if
/// none puts the points in front of the camera with the board's z towards it.
///
/// @param points_board_m  at least 4, with z = 0, not collinear.
/// @param pixels_px       of the same points.
std::optional<PlanarPose> FitPlanarPose(const CameraModel& camera,
                                        const std::vector<Eigen::Vector3d>& points_board_m,
                                        const std::vector<Eigen::Vector2d>& pixels_px);

/// The same by the points whose pixels are known: NaN is a corner that was not seen. Nothing too if
/// fewer than 4 are.
std::optional<PlanarPose> FitSeenCorners(const CameraModel& camera,
                                         const std::vector<Eigen::Vector3d>& points_board_m,
                                         const std::vector<Eigen::Vector2d>& pixels_px);

}  // namespace voqcal
