#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/estimation/combine.hpp"
#include "core/estimation/refine.hpp"
#include "core/likelihood/likelihood_estimate.hpp"
#include "core/scene/scene_refinement.hpp"
#include "core/scene/scene_view.hpp"

namespace voqcal {

/// One extrinsic of all that there is to go by: the boards' centres, which assume nothing of the
/// lidar; ranges and planes, as far as they agree; the edges of the scenes.
struct JointExtrinsic {
  std::string problem;      ///< Why there is none; empty if there is one.
  CombinedExtrinsic board;  ///< Reprojection and likelihood.
  SceneRefinement scene;    ///< Of that; the result.

  bool IsUsable() const { return problem.empty(); }
  const Eigen::Isometry3d& T_camera_lidar() const { return scene.T_camera_lidar; }
  const Matrix6d& covariance() const { return scene.covariance; }

  /// What it would be had one board not been there, from the estimates without it; the scenes are
  /// kept, which do not show the board. Linear.
  Eigen::Isometry3d Without(const Eigen::Isometry3d& T_reprojection,
                            const Eigen::Isometry3d& T_likelihood) const;
};

/// @param likelihood  null if there is none.
JointExtrinsic RefineJointly(const RefinedExtrinsic& reprojection,
                             const LikelihoodExtrinsic* likelihood,
                             const std::vector<SceneView>& views,
                             const CameraModel& camera,
                             const SceneRefinementOptions& options);

}  // namespace voqcal
