#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/lens_errors.hpp"
#include "core/estimation/lidar_bias.hpp"
#include "core/estimation/refine.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// What is expected before the data speak. Model errors add to the detectors' covariances; how far
/// to believe the sum is estimated from the data.
struct LikelihoodOptions {
  double common_prior_m = 0.03;     ///< 1 sigma of the offset common to all ranges.
  double dark_step_prior_m = 0.03;  ///< 1 sigma of dark against bright surfaces.
  double ring_prior_m = 0.015;      ///< 1 sigma of each scan line's own offset.
  /// 1 sigma of an error of the outlines' height (along the lidar's z) that all sweeps share: scan
  /// lines cut the outline coarsely, and always at the same elevations.
  double outline_lift_prior_m = 0.001;
  double outline_rise_prior = 0.0005;  ///< The same, growing with the range: metres a metre.
  double outline_error_m = 0.001;      ///< 1 sigma of the outline fit's centre, beyond its noise.
  double outline_error_rad = 0.003;    ///< 1 sigma of its turn in the plane.
  double camera_error_m = 0.003;       ///< 1 sigma of the chessboard's depth, beyond its noise...
  double camera_error_rad = 0.005;  ///< ...and of its tilt: the board bends, the lens model errs.
  // Plausible errors of what was measured beforehand; a covariance smaller than their effect is
  // widened to it.
  double focal_length_error = 0.0003;     ///< 1 sigma, relative.
  double principal_point_error_px = 0.2;  ///< 1 sigma in each direction.
  double board_size_error = 0.0005;       ///< 1 sigma of a chessboard square, relative.
  /// 1 sigma of each of the LensErrors, where they are estimated (RefineWithLens).
  double lens_error = 0.005;
  /// 1 sigma of a chessboard's corner there: more than its noise, as neighbours err alike.
  double corner_error_px = 0.3;
  int max_iterations = 50;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// Noise levels that the residuals show; as they start, where there are no residuals.
struct LikelihoodNoise {
  double range_m = 0.01;        ///< 1 sigma of one return along its ray.
  double outline_factor = 1.0;  ///< On the outline's expected 1 sigma.
  double camera_factor = 1.0;   ///< On the chessboard's expected 1 sigma, lidar planes comparing.
};

/// How far the extrinsic may be off, 1 sigma of [rotation_rad; translation_m] perturbed on the left
/// (camera side), by three ways of telling. Its covariance is the likelihood's, widened for each
/// parameter to the largest.
struct LikelihoodUncertainty {
  /// The inverse information; faults that the data cannot tell count with their priors.
  Vector6d by_likelihood = Vector6d::Constant(std::numeric_limits<double>::quiet_NaN());
  /// By the poses' own variety (UncertaintyOf).
  Vector6d by_resampling = by_likelihood;
  /// Estimated again with lens and board in error.
  Vector6d by_model_errors = by_likelihood;
  Matrix6d covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// Errors of the intrinsics that were given. What the data cannot tell stays zero.
struct LensEstimate {
  LensErrors errors = LensErrors::Zero();
  LensErrors standard_errors = LensErrors::Constant(std::numeric_limits<double>::quiet_NaN());
  std::array<bool, kNumLensErrors> is_observable{};  ///< As BiasEstimate's.

  bool IsObservable() const;  ///< Any of them.
};

/// An extrinsic with the lidar's faults that came with it.
struct LikelihoodExtrinsic {
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  LikelihoodUncertainty uncertainty;
  LidarBias bias;
  LensEstimate lens;  ///< RefineWithLens'; the extrinsic then goes with the corrected camera.
  LikelihoodNoise noise;
  double range_rms_m = std::numeric_limits<double>::quiet_NaN();   ///< Of all returns.
  double across_rms_m = std::numeric_limits<double>::quiet_NaN();  ///< Of the centres' rays.
  int num_returns = 0;
  RefineStatus status = RefineStatus::kNotConverged;

  bool IsUsable() const { return status == RefineStatus::kConverged; }
  std::string Summary() const;  ///< One line for a log.
};

/// Refines `T_camera_lidar_start` by one likelihood over all poses. Unknown are the extrinsic, the
/// lidar's faults (LidarBias) and each board's pose, which the chessboard holds. The lidar says:
/// each return's range to the board's plane, and the rays to the outline's centre and along its
/// axes, which errors of range leave alone. A fault that the data do not narrow to half its prior
/// stays zero, "unobservable".
///
/// kDegenerate: fewer than three samples, or parameters that the poses leave open. kNotConverged:
/// out of iterations, or a board that is not before both sensors; the transform is then the start.
/// @throws std::invalid_argument if `options` has Problems().
LikelihoodExtrinsic RefineByLikelihood(const std::vector<const BoardSample*>& samples,
                                       const CameraModel& camera,
                                       const Eigen::Isometry3d& T_camera_lidar_start,
                                       const LikelihoodOptions& options);

/// The same for nearly the samples that `nearby` was refined over (leave-one-out), in a few steps
/// from there: noise levels, the scale of shades, which faults are observable and every standard
/// error stay its.
LikelihoodExtrinsic RefineNearby(const std::vector<const BoardSample*>& samples,
                                 const LikelihoodExtrinsic& nearby,
                                 const LikelihoodOptions& options);

/// As RefineByLikelihood, with the errors of the intrinsics (LensErrors) unknown too: each
/// chessboard's pose answers to them, and what its corners are off in the image tells of them
/// (LensTerms). The extrinsic goes with CorrectedCamera, not with `camera`: the principal point and
/// the rotation make up for one another.
LikelihoodExtrinsic RefineWithLens(const std::vector<const BoardSample*>& samples,
                                   const BoardSpec& board,
                                   const CameraModel& camera,
                                   const Eigen::Isometry3d& T_camera_lidar_start,
                                   const LikelihoodOptions& options);

/// The same for nearly the samples that `nearby` was refined over, as RefineNearby.
LikelihoodExtrinsic RefineWithLensNearby(const std::vector<const BoardSample*>& samples,
                                         const BoardSpec& board,
                                         const CameraModel& camera,
                                         const LikelihoodExtrinsic& nearby,
                                         const LikelihoodOptions& options);

}  // namespace voqcal
