#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/likelihood/likelihood_estimate.hpp"
#include "core/likelihood/likelihood_options.hpp"

namespace voqcal {

/// Refines `T_camera_lidar_start` by one likelihood over all poses. Unknown are the extrinsic, the
/// lidar's faults (LidarBias), the turn that all chessboards share against their rays
/// (ChessboardTurnTerms), and each board's pose, which the chessboard holds. The lidar says:
/// each return's range to the board's plane, and the rays to the outline's centre and along its
/// axes, which errors of range leave alone. A fault that the data do not narrow to half its prior
/// stays zero, "unobservable".
///
/// kDegenerate: fewer than three samples, or parameters that the poses leave open. kNotConverged:
/// out of iterations, or a board that is not before both sensors; the transform is then the start.
/// @throws std::invalid_argument if `options` has Problems().
LikelihoodExtrinsic RefineByLikelihood(const std::vector<const BoardSample*>& samples,
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
/// (CameraFaultTerms). The extrinsic goes with CorrectedCamera, not with `camera`: the principal
/// point and the rotation make up for one another.
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
