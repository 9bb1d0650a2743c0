#include "core/assessment/joint_extrinsic.hpp"

#include <Eigen/LU>

namespace voqcal {

Eigen::Isometry3d JointExtrinsic::Without(const Eigen::Isometry3d& T_reprojection,
                                          const Eigen::Isometry3d& T_likelihood) const {
  const Eigen::Isometry3d T_board =
      PerturbLeft(T_reprojection, board.gain * DifferenceLeft(T_reprojection, T_likelihood));
  // The board's share of what is known: the rest is the scene's.
  const Matrix6d share = scene.is_used
                             ? Matrix6d(scene.covariance * board.extrinsic.covariance.inverse())
                             : Matrix6d(Matrix6d::Identity());
  return PerturbLeft(scene.T_camera_lidar,
                     share * DifferenceLeft(board.extrinsic.T_camera_lidar, T_board));
}

JointExtrinsic RefineJointly(const RefinedExtrinsic& reprojection,
                             const LikelihoodExtrinsic* likelihood,
                             const std::vector<SceneView>& views,
                             const CameraModel& camera,
                             const SceneRefinementOptions& options) {
  JointExtrinsic joint;
  if (!reprojection.IsUsable()) {
    joint.problem = "the reprojection is " + ToString(reprojection.status);
    return joint;
  }
  if (!reprojection.covariance.allFinite()) {
    joint.problem = "too few poses to tell how well they hold it";
    return joint;
  }
  const UncertainExtrinsic robust{reprojection.T_camera_lidar, reprojection.covariance};
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
