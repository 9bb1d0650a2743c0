#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/estimation/combine.hpp"
#include "core/estimation/variance_components.hpp"
#include "core/likelihood/likelihood_estimate.hpp"
#include "core/scene/scene_refinement.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

/// One extrinsic of all that there is to go by: what both detectors say of the boards, with errors
/// as large as they disagree; the returns themselves, with the lidar's faults, as far as they agree
/// with that; the edges of the scenes.
struct JointExtrinsic {
  std::string problem;      ///< Why there is none; empty if there is one.
  MixedFit sightings;       ///< Of the boards as detected.
  CombinedExtrinsic board;  ///< Of that and the likelihood.
  SceneRefinement scene;    ///< Of that; the result.

  bool IsUsable() const { return problem.empty(); }
  const Eigen::Isometry3d& T_camera_lidar() const { return scene.T_camera_lidar; }
  const Matrix6d& covariance() const { return scene.covariance; }

  /// What it would be had one board not been there, from the estimates without it; the scenes are
  /// kept, which do not show the board. Linear.
  /// @param likelihood  null if there is none.
  Eigen::Isometry3d Without(const MixedFit& others, const LikelihoodExtrinsic* likelihood) const;
};

/// @param likelihood  null if there is none; the scenes must then have something to say.
JointExtrinsic RefineJointly(const std::vector<const BoardSample*>& samples,
                             const Eigen::Isometry3d& T_camera_lidar_start,
                             const LikelihoodExtrinsic* likelihood,
                             const std::vector<SceneView>& views,
                             const CameraModel& camera,
                             const SceneRefinementOptions& options);

}  // namespace voqcal
