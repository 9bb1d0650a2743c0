#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/lens_errors.hpp"
#include "core/geometry/rigid.hpp"
#include "core/likelihood/likelihood_estimate.hpp"
#include "core/likelihood/likelihood_options.hpp"

namespace voqcal {

/// Errors of what a rig file says of camera and board: LensErrors, and after them the board's.
enum RigError : Eigen::Index {
  kSquares = kNumLensErrors,  ///< The true squares are (1 + value) times those given.
  kPatternOffsetX,            ///< The true pattern is off by this along the plate's x, metres...
  kPatternOffsetY,            ///< ...and y.
  kNumRigErrors
};
using RigErrors = Eigen::Matrix<double, kNumRigErrors, 1>;

/// 1 sigma of each, before the samples speak.
RigErrors PlausibleRigErrors(const LikelihoodOptions& options);

/// By how much the errors that the rig file may have widen an extrinsic that is refined as if it
/// had none: of [rotation_rad; translation_m], perturbed on the left (camera) side. The errors l
/// are normal around zero beforehand, as wide as plausible (PlausibleRigErrors), or, the lens' and
/// the board's each, as much wider as the samples ask for. The samples then say of them the mean m
/// and the covariance P, and the extrinsic follows them by J:
///     J (P + m m') J'
/// Where the samples ask for another lens, the interval reaches to the extrinsic that goes with it.
/// The chessboards' turn and the lidar's faults are as unknown as they were in the refinement.
///
/// @param refined  as if the rig file had no errors: the start, its noise levels and lidar faults.
/// @return NaN where the search fails.
/// @throws std::invalid_argument if `options` has Problems().
Matrix6d CovarianceByRigErrors(const std::vector<const BoardSample*>& samples,
                               const BoardSpec& board,
                               const CameraModel& camera,
                               const LikelihoodExtrinsic& refined,
                               const LikelihoodOptions& options);

}  // namespace voqcal
