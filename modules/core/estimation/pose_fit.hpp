#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/pose_difference.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// The extrinsic that the poses of both sensors give by their covariances alone.
struct PoseFit {
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left; as wide as the poses differ, where
  /// they differ by more than their covariances say.
  Matrix6d covariance = Matrix6d::Zero();
  bool is_usable = false;  ///< False if the poses leave something open, or do not converge.
};

/// Minimises the robust sum of PoseDifference::SquaredSigmas from `T_camera_lidar_start`. Sightings
/// count for what they say: a board of which only the plane was measured fixes a plane.
PoseFit FitPoses(const std::vector<const BoardSample*>& samples,
                 const CameraModel& camera,
                 const Eigen::Isometry3d& T_camera_lidar_start,
                 const NominalNoise& nominal);

}  // namespace voqcal
