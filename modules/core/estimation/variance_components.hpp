#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/sighting_errors.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// [the extrinsic's perturbation (6); SharedErrors (5), in their order].
constexpr int kNumSharedErrors = 5;
static_assert(sizeof(SharedErrors) == kNumSharedErrors * sizeof(double));
constexpr int kMixedSize = 6 + kNumSharedErrors;
using MixedVector = Eigen::Matrix<double, kMixedSize, 1>;
using MixedMatrix = Eigen::Matrix<double, kMixedSize, kMixedSize>;

/// An extrinsic with the errors of the sightings that it was fitted to, estimated together.
struct MixedFit {
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  SharedErrors shared;
  SharedErrors shared_prior = kPriorSharedErrors;  ///< 1 sigma of each before the data spoke.
  MixedMatrix covariance = MixedMatrix::Zero();
  SightingErrors errors;
  bool is_usable = false;  ///< False if the poses leave something open, or do not converge.

  Matrix6d ExtrinsicCovariance() const { return covariance.topLeftCorner<6, 6>(); }
  /// The shared errors if the extrinsic is a given one, near the fit's.
  SharedErrors SharedAt(const Eigen::Isometry3d& T_camera_lidar_given) const;
  /// Of them, with its standard error as for the fit's own extrinsic.
  ChessboardTurn ChessboardTurnAt(const Eigen::Isometry3d& T_camera_lidar_given) const;
};

/// PoseDifference with the errors of `fit`: those that are shared taken out, the others in C.
struct MixedDifference {
  Vector6d r;
  Matrix6d C;
  Eigen::Matrix<double, 6, kMixedSize> J;
};
MixedDifference DifferenceOf(const BoardSample& sample,
                             const CameraModel& camera,
                             const MixedFit& fit);

/// What is known of MixedVector before any board was seen, as information.
MixedMatrix MixedPriorInformation(const SharedErrors& prior = kPriorSharedErrors);

/// What the session's boards disagree by beyond their own covariances, as variance components: each
/// sighting has random errors of five kinds (SightingErrors), of the same size in all sightings,
/// and all have the SharedErrors. Restricted maximum likelihood, so that the unknowns of the
/// session are not mistaken for agreement (Patterson and Thompson 1971, "Recovery of inter-block
/// information when block sizes are unequal", Biometrika 58), by the multiplicative steps of Zhou
/// et al. 2019, "MM algorithms for variance components models", J. Comp. Graph. Stat. 28: monotone,
/// and never negative.
///
/// Each variance has a prior (kPriorErrors) that counts as one more observation or half of one
/// (kPriorWeights): it decides where a few samples cannot tell, and hardly matters among many.
/// @return a fit that is not usable where the poses leave the extrinsic open.
MixedFit FitWithErrors(const std::vector<const BoardSample*>& samples,
                       const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar_start,
                       const ErrorPriors& priors = {});

/// The same for nearly the samples that `nearby` was fitted to (leave-one-out): the sightings'
/// errors stay its.
MixedFit FitNearby(const std::vector<const BoardSample*>& samples,
                   const CameraModel& camera,
                   const MixedFit& nearby);

}  // namespace voqcal
