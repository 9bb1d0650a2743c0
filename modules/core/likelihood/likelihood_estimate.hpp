#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/lens_errors.hpp"
#include "core/estimation/refine_status.hpp"
#include "core/estimation/sighting_errors.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/lidar_bias.hpp"

namespace voqcal {

/// Noise levels that the residuals show; as they start, where there are no residuals.
struct LikelihoodNoise {
  double range_m = 0.01;  ///< 1 sigma of one return along its ray.
  // Of each sighting, beyond the detectors' covariances and once the lidar's faults are taken out:
  double along_ray_m = 0.003;   ///< Of the chessboard's centre.
  double across_ray_m = 0.001;  ///< Of the outline's centre, each way alike.
  double tilt_rad = 0.005;      ///< Of the chessboard's normal, in each direction.
  double turn_rad = 0.003;      ///< Of the outline, about the normal.
};

/// How far the extrinsic may be off, 1 sigma of [rotation_rad; translation_m] perturbed on the left
/// (camera side) if the rig file is right, by two ways of telling. Its covariance is the
/// likelihood's, widened for each parameter to the larger.
struct LikelihoodUncertainty {
  /// The inverse information; faults that the data cannot tell count with their priors. In the
  /// covariance it is wider the fewer poses told the noise levels.
  Vector6d by_likelihood = Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  /// By the poses' own variety (UncertaintyOf).
  Vector6d by_resampling = by_likelihood;
  Matrix6d covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// Errors of the intrinsics that were given. What the data cannot tell stays zero.
struct LensEstimate {
  LensErrors errors = LensErrors::Zero();
  LensErrors standard_errors = LensErrors::Constant(std::numeric_limits<double>::quiet_NaN());
  std::array<bool, kNumLensErrors> is_observable{};  ///< As BiasEstimate's.

  bool IsObservable() const;  ///< Any of them.
};

/// What the poses' CameraFaultTerms ask for, in their order and units.
struct CameraFaultEstimates {
  Eigen::VectorXd values;
  Eigen::VectorXd standard_errors;
  std::vector<bool> is_observable;
};

/// An extrinsic with the lidar's faults that came with it.
struct LikelihoodExtrinsic {
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  LikelihoodUncertainty uncertainty;
  LidarBias bias;
  /// The bias, in the order and units of LikelihoodState; empty: not known.
  Eigen::VectorXd lidar_faults;
  /// How they, and after them camera_faults, follow a given extrinsic: by [rotation_rad;
  /// translation_m], left side.
  Eigen::Matrix<double, Eigen::Dynamic, 6> faults_by_extrinsic;
  CameraFaultEstimates
      camera_faults;  ///< The chessboards' turn (ChessboardTurnTerms), or LensErrors.
  LensEstimate lens;  ///< RefineWithLens'; the extrinsic then goes with the corrected camera.
  LikelihoodNoise noise;
  double range_rms_m = std::numeric_limits<double>::quiet_NaN();   ///< Of all returns.
  double across_rms_m = std::numeric_limits<double>::quiet_NaN();  ///< Of the centres' rays.
  int num_returns = 0;
  RefineStatus status = RefineStatus::kNotConverged;

  bool IsUsable() const { return status == RefineStatus::kConverged; }
  /// The most likely bias if that is the extrinsic; to first order.
  LidarBias BiasAt(const Eigen::Isometry3d& T_camera_lidar_given) const;
  /// The same of the chessboards' turn; not estimated where LensErrors were asked for, or nothing
  /// is known. Its standard error is as for the likelihood's own extrinsic, as the bias' are.
  ChessboardTurn ChessboardTurnAt(const Eigen::Isometry3d& T_camera_lidar_given) const;
  std::string Summary() const;  ///< One line for a log.
};

/// Puts the faults' values into `bias`; which of them are observable, and how well, stays.
void SetFaults(const Eigen::VectorXd& lidar_faults, LidarBias* bias);

}  // namespace voqcal
