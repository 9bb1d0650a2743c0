#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/enough.hpp"
#include "core/assessment/worst_error.hpp"
#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/guidance/expected_sample.hpp"
#include "core/guidance/extrinsic_information.hpp"
#include "core/guidance/placement.hpp"
#include "core/likelihood/likelihood.hpp"

namespace voqcal {

/// What is asked of the extrinsic, and how its samples are expected to be.
struct GuidanceOptions {
  EnoughOptions enough;
  SensorExpectation sensors;
  PlacementLimits limits;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// What does not change in a session.
struct GuidedRig {
  BoardSpec board;
  CameraModel camera;
  LikelihoodOptions likelihood;
};

/// Where a session stands.
struct GuidanceState {
  std::vector<const BoardSample*> samples;  ///< That agree with one another, oldest first.
  /// The best there is; nothing: it is taken from the newest sample, if there is one.
  std::optional<ExtrinsicBelief> belief;
  /// The extrinsic's as it was published; nothing if it was not.
  std::optional<Matrix6d> covariance;
};

/// Where to hold the board next, and whether another sample is needed.
struct NextPose {
  std::string problem;  ///< Why no pose is asked for; what describes one is then meaningless.
  /// By the published covariance; without one, by what the samples tell. Infinite without any.
  WorstError worst;
  /// By JudgeEnough, of the published covariance. The samples'
  /// information alone does not do: it knows nothing of errors that the likelihood does not model.
  bool is_enough = false;
  /// After a sample of the pose; NaN if there is none.
  double predicted_worst_error = std::numeric_limits<double>::quiet_NaN();
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Isometry3d> T_lidar_board;  ///< Nothing as long as no extrinsic is known.
  std::string advice;  ///< Enough::words if it is, else HoldWords; empty if there is a problem.
};

/// The board's pose that lowers the worst predicted error most, of all that both sensors can see
/// well and that are not like a sample's: the best of a coarse grid of places, then searched on
/// with tilts in ever smaller steps.
///
/// Predicted is the samples' information and that of the pose, widened: a published covariance C
/// that is larger than the samples' information allows (what a resampling or a model error tells)
/// stays so many times larger with the next sample: of each parameter the ratio of both 1 sigmas,
/// at least 1, as RefineByLikelihood widens its own.
///
/// Without a sample the lidar is taken to look where the camera does.
/// @throws std::invalid_argument if `options` has Problems().
NextPose ProposeNextPose(const GuidanceState& state,
                         const GuidedRig& rig,
                         const GuidanceOptions& options);

}  // namespace voqcal
