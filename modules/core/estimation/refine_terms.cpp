#include "core/estimation/refine_terms.hpp"

#include <Eigen/Eigenvalues>

#include "core/board/half_turn.hpp"
#include "core/board/what_was_measured.hpp"
#include "core/estimation/left_perturbation.hpp"

namespace voqcal {

PointReprojectionCost::PointReprojectionCost(const CameraModel& camera,
                                             const Eigen::Isometry3d& T_camera_lidar_start,
                                             const Eigen::Vector3d& point_lidar_m,
                                             const Eigen::Vector2d& point_px,
                                             const Eigen::Matrix2d& trust)
    : camera_(camera),
      T_camera_lidar_start_(T_camera_lidar_start),
      point_lidar_m_(point_lidar_m),
      point_px_(point_px),
      trust_(trust) {}

bool PointReprojectionCost::Evaluate(const double* const* parameters,
                                     double* residual,
                                     double** jacobians) const {
  const LeftPerturbation at(T_camera_lidar_start_, Eigen::Map<const Vector6d>(parameters[0]));
  const Eigen::Vector3d point_camera_m = at.T_camera_lidar() * point_lidar_m_;
  if (!camera_.IsProjectable(point_camera_m)) return false;  // Ceres rejects the step
  Eigen::Map<Eigen::Vector2d> r(residual);
  if (jacobians == nullptr || jacobians[0] == nullptr) {
    r = trust_ * (camera_.Project(point_camera_m) - point_px_);
    return true;
  }
  Matrix23d J_px_point;
  r = trust_ * (ProjectWithJacobian(camera_, point_camera_m, &J_px_point) - point_px_);
  Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>> J(jacobians[0]);
  J = trust_ * J_px_point * at.PointJacobian(point_camera_m);
  return true;
}

Eigen::Matrix2d PointTrust(const LidarBoard& lidar,
                           const Eigen::Vector3d& point_lidar_m,
                           const CameraModel& camera,
                           const Eigen::Isometry3d& T_camera_lidar,
                           double scale_px) {
  if (IsWhole(lidar)) return Eigen::Matrix2d::Identity();
  Matrix36d by_pose;
  by_pose << -Skew(point_lidar_m - lidar.pose.centre_m), Eigen::Matrix3d::Identity();
  Matrix23d J_px_point;
  ProjectWithJacobian(camera, T_camera_lidar * point_lidar_m, &J_px_point);
  const Eigen::Matrix<double, 2, 6> J_px = J_px_point * T_camera_lidar.linear() * by_pose;
  const Eigen::Matrix2d ratio = Eigen::Matrix2d::Identity() + J_px * lidar.pose.covariance *
                                                                  J_px.transpose() /
                                                                  (scale_px * scale_px);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(ratio).operatorInverseSqrt();
}

std::vector<RefineTerm> MakeRefineTerms(const std::vector<const BoardSample*>& samples,
                                        const CameraModel& camera,
                                        const Eigen::Isometry3d& T_camera_lidar_start,
                                        const RefineOptions& options) {
  std::vector<RefineTerm> terms;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const BoardPose lidar = LidarPoseInCameraOrder(*samples[i], T_camera_lidar_start);
    const BoardPose& seen = samples[i]->camera.pose;
    const auto add = [&](double weight,
                         const Eigen::Vector3d& lidar_m,
                         const Eigen::Vector3d& camera_m) {
      if (!(weight > 0.0)) return;
      terms.push_back(
          {static_cast<int>(i),
           weight,
           std::make_unique<PointReprojectionCost>(
               camera,
               T_camera_lidar_start,
               lidar_m,
               camera.Project(camera_m),
               PointTrust(
                   samples[i]->lidar, lidar_m, camera, T_camera_lidar_start, options.huber_px))});
    };
    add(options.centre_weight, lidar.centre_m, seen.centre_m);
    for (std::size_t k = 0; k < 4; ++k) {
      add(options.corner_weight, lidar.corners_m[k], seen.corners_m[k]);
    }
  }
  return terms;
}

}  // namespace voqcal
