#include "core/estimation/refine_terms.hpp"

#include "core/board/half_turn.hpp"
#include "core/estimation/left_perturbation.hpp"

namespace voqcal {

PointReprojectionCost::PointReprojectionCost(const CameraModel& camera,
                                             const Eigen::Isometry3d& T_camera_lidar_start,
                                             const Eigen::Vector3d& point_lidar_m,
                                             const Eigen::Vector2d& point_px)
    : camera_(camera),
      T_camera_lidar_start_(T_camera_lidar_start),
      point_lidar_m_(point_lidar_m),
      point_px_(point_px) {}

bool PointReprojectionCost::Evaluate(const double* const* parameters,
                                     double* residual,
                                     double** jacobians) const {
  const LeftPerturbation at(T_camera_lidar_start_, Eigen::Map<const Vector6d>(parameters[0]));
  const Eigen::Vector3d point_camera_m = at.T_camera_lidar() * point_lidar_m_;
  if (!camera_.IsProjectable(point_camera_m)) return false;  // Ceres rejects the step
  Eigen::Map<Eigen::Vector2d> r(residual);
  if (jacobians == nullptr || jacobians[0] == nullptr) {
    r = camera_.Project(point_camera_m) - point_px_;
    return true;
  }
  Matrix23d J_px_point;
  r = ProjectWithJacobian(camera_, point_camera_m, &J_px_point) - point_px_;
  Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>> J(jacobians[0]);
  J = J_px_point * at.PointJacobian(point_camera_m);
  return true;
}

std::vector<RefineTerm> MakeRefineTerms(const std::vector<const BoardSample*>& samples,
                                        const CameraModel& camera,
                                        const Eigen::Isometry3d& T_camera_lidar_start,
                                        const RefineOptions& options) {
  std::vector<RefineTerm> terms;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const BoardPose lidar = LidarPoseInCameraOrder(*samples[i], T_camera_lidar_start);
    const BoardPose& seen = samples[i]->camera.pose;
    const auto add =
        [&](double weight, const Eigen::Vector3d& lidar_m, const Eigen::Vector3d& camera_m) {
          if (!(weight > 0.0)) return;
          terms.push_back({static_cast<int>(i),
                           weight,
                           std::make_unique<PointReprojectionCost>(
                               camera, T_camera_lidar_start, lidar_m, camera.Project(camera_m))});
        };
    add(options.centre_weight, lidar.centre_m, seen.centre_m);
    for (std::size_t k = 0; k < 4; ++k) {
      add(options.corner_weight, lidar.corners_m[k], seen.corners_m[k]);
    }
  }
  return terms;
}

}  // namespace voqcal
