#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/pose_fit.hpp"
#include "core/estimation/sighting_errors.hpp"

namespace voqcal {

/// An extrinsic with the errors of the sightings that it was fitted to, estimated together.
struct MixedFit {
  PoseFit fit;  ///< Weighted by the errors.
  SightingErrors errors;
};

/// What the session's boards disagree by beyond their own covariances, as variance components: each
/// sighting has random errors of four kinds (SightingErrors), of the same size in all sightings.
/// Restricted maximum likelihood, so that the extrinsic's own six unknowns are not mistaken for
/// agreement (Patterson and Thompson 1971, "Recovery of inter-block information when block sizes
/// are unequal", Biometrika 58), by the multiplicative steps of Zhou et al. 2019, "MM algorithms
/// for variance components models", J. Comp. Graph. Stat. 28: monotone, and never negative.
///
/// Each variance has a prior that counts as one more observation (kPriorErrors): it decides where a
/// few samples cannot tell, and hardly matters among many.
/// @return a fit that is not usable where the poses leave the extrinsic open.
MixedFit FitWithErrors(const std::vector<const BoardSample*>& samples,
                       const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar_start);

}  // namespace voqcal
