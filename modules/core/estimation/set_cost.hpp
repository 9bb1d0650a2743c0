#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/left_perturbation.hpp"
#include "core/estimation/set_extrinsic.hpp"

namespace voqcal {

/// What one pose brings into the cost of a set.
struct SetPose {
  Eigen::Vector3d normal_lidar, normal_camera;
  Eigen::Vector3d centre_lidar_m, centre_camera_m;
  Eigen::Vector2d centre_px;
  Eigen::Vector3d edge_x_camera, edge_y_camera;  ///< Unit, along the board's two directions.
  /// What the centre's residuals are multiplied by besides: one for a whole sighting, less where
  /// open sides leave the lidar's centre uncertain.
  Eigen::Matrix3d centre_trust = Eigen::Matrix3d::Identity();
  double centre_px_trust = 1.0;
};

/// @param R_camera_lidar  roughly: turns what open sides leave uncertain into the camera's axes.
std::vector<SetPose> SetPosesOf(const std::vector<const BoardSample*>& set,
                                const CameraModel& camera,
                                const Eigen::Matrix3d& R_camera_lidar,
                                const SetExtrinsicOptions& options);

/// SetPose::centre_trust: (I + C / sigma_centre^2)^-1/2 with C the centre's covariance in the
/// camera's axes; one for a whole sighting, whose errors the options tell.
Eigen::Matrix3d CentreTrust(const LidarBoard& lidar,
                            const Eigen::Matrix3d& R_camera_lidar,
                            double sigma_centre_m);

/// The cost of one set, whitened, ten residuals a pose, with R n the rotated lidar normal:
///     perpendicularity   e_x . R n / sigma_normal, e_y . R n / sigma_normal
///     normal alignment   (R n_lidar - n_camera) / sigma_normal                          3
///     centre alignment   (R c_lidar + t - c_camera) / sigma_centre_m                    3
///     reprojection       (project(R c_lidar + t) - project(c_camera)) / sigma_centre_px 2
/// Parameters: delta of T(delta) = PerturbLeft(T_start, delta), [rotation_rad; translation_m].
///
/// These are the terms of Verma et al. 2019 (arXiv:1904.12433), where a genetic algorithm minimises
/// their weighted sum. Departures, so that it is one smooth least-squares problem:
/// - The published centre term is the mean plus the standard deviation of the centres' distances.
///   The sum of their squares is n (mean^2 + std^2): the same two moments, differentiable at zero.
/// - A rigid board's camera edges are exactly perpendicular to its camera normal, so
///   perpendicularity says again what the alignment of normals says of tilt: together they weigh
///   it by sigma_normal / sqrt(2). The reprojection likewise weighs a centre again across the view.
/// - The published reprojection term is the worst pose's. Squares already let the worst weigh most;
///   a maximum has kinks where the worst pose changes.
/// - Perpendicularity takes the two directions of the board, each the mean of two opposite edges:
///   opposite edges of the camera's rigid board say the same.
/// - The terms are divided by what each may err by (the options), not added in unlike units.
struct SetCost {
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = 6 };
  static constexpr int kResidualsPerPose = 10;
  using Residuals = Eigen::Matrix<double, kResidualsPerPose, 1>;
  using Jacobian = Eigen::Matrix<double, kResidualsPerPose, 6>;

  const std::vector<SetPose>& poses;
  const CameraModel& camera;
  const Eigen::Isometry3d& T_camera_lidar_start;
  const SetExtrinsicOptions& options;

  int NumResiduals() const { return kResidualsPerPose * static_cast<int>(poses.size()); }

  /// ceres::TinySolver's interface: column-major Jacobian, null if not wanted. False behind the
  /// camera, where no pixel exists.
  bool operator()(const double* delta, double* residuals, double* jacobian) const;

 private:
  bool Evaluate(const SetPose& pose, const LeftPerturbation& at, Residuals* r, Jacobian* J) const;
};

}  // namespace voqcal
