#pragma once

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/assessment/best_extrinsic.hpp"
#include "core/assessment/scores.hpp"
#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/likelihood/likelihood.hpp"

namespace voqcal {

/// What the samples say of the camera's intrinsics, and the extrinsic that goes with corrected
/// ones. Who keeps the intrinsics that were given keeps the extrinsic that was refined with them:
/// this one would be off in their image by as much as the principal point moves.
struct LensCorrection {
  std::string problem = "not tried";  ///< Why there is none, a sentence; empty if there is one.
  LensEstimate errors;
  CameraModel camera;  ///< Corrected.
  /// Takes lidar coordinates to coordinates of the corrected camera.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (camera) side.
  Matrix6d covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  /// Each pose by extrinsic, intrinsics and lidar's faults as they were estimated without it.
  SceneScore held_out;

  bool IsUsable() const { return problem.empty(); }
};

/// Refines with the lens' errors (RefineWithLens). There is no correction where the samples lack
/// the lidar's points or the chessboards' pixels, or do not tell it, where the corrected lens
/// reaches less of the image, or where the error of poses held out (CombinedErrorMm) does not fall
/// by a tenth against the intrinsics that were given.
///
/// @param T_camera_lidar    refined with the intrinsics that were given: the start.
/// @param held_out_without  the likelihood's scores with the intrinsics that were given.
/// @throws std::invalid_argument if `options` has Problems().
LensCorrection CorrectLens(const std::vector<const BoardSample*>& samples,
                           const BoardSpec& board,
                           const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_lidar,
                           const SceneScore& held_out_without,
                           const LikelihoodOptions& options);

/// "the samples ask for another lens: focal length +0.67 %, ...", with the errors of boards held
/// out by both; empty if there is no correction.
///
/// @param held_out  the result's, with the intrinsics that were given.
std::string OtherLens(const LensCorrection& correction, const SceneScore& held_out);

/// Which of the two extrinsics to take, for people; empty if there is no correction.
///
/// @param T_camera_lidar  the result with the intrinsics that were given.
std::string WhichToTake(const LensCorrection& correction, const Eigen::Isometry3d& T_camera_lidar);

}  // namespace voqcal
