#include "core/assessment/joint_extrinsic.hpp"

#include <Eigen/LU>

namespace voqcal {

Eigen::Isometry3d JointExtrinsic::Without(const MixedFit& others,
                                          const LikelihoodExtrinsic* likelihood) const {
  Eigen::Isometry3d T_board = others.T_camera_lidar;
  if (likelihood != nullptr) {
    T_board =
        PerturbLeft(T_board, board.gain * DifferenceLeft(T_board, likelihood->T_camera_lidar));
  }
  // The board's share of what is known: the rest is the scene's.
  const Matrix6d share = scene.is_used
                             ? Matrix6d(scene.covariance * board.extrinsic.covariance.inverse())
                             : Matrix6d(Matrix6d::Identity());
  return PerturbLeft(scene.T_camera_lidar,
                     share * DifferenceLeft(board.extrinsic.T_camera_lidar, T_board));
}

JointExtrinsic RefineJointly(const std::vector<const BoardSample*>& samples,
                             const Eigen::Isometry3d& T_camera_lidar_start,
                             const LikelihoodExtrinsic* likelihood,
                             const std::vector<SceneView>& views,
                             const CameraModel& camera,
                             const SceneRefinementOptions& options) {
  JointExtrinsic joint;
  if (likelihood == nullptr && views.empty()) {
    joint.problem = "there is nothing to join: no likelihood, no scenes";
    return joint;
  }
  joint.sightings = FitWithErrors(samples, camera, T_camera_lidar_start);
  if (!joint.sightings.is_usable) {
    joint.problem = "the boards leave the extrinsic open";
    return joint;
  }
  const UncertainExtrinsic robust{joint.sightings.T_camera_lidar,
                                  joint.sightings.ExtrinsicCovariance()};
  joint.board.extrinsic = robust;
  if (likelihood != nullptr && likelihood->uncertainty.covariance.allFinite()) {
    joint.board = Combine(robust, {likelihood->T_camera_lidar, likelihood->uncertainty.covariance});
  }
  joint.scene = RefineByScene(views,
                              camera,
                              joint.board.extrinsic.T_camera_lidar,
                              joint.board.extrinsic.covariance,
                              options);
  if (!joint.scene.T_camera_lidar.matrix().allFinite()) joint.problem = "the refinement diverges";
  return joint;
}

}  // namespace voqcal
