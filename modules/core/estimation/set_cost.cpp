#include "core/estimation/set_cost.hpp"

#include <Eigen/Eigenvalues>

#include "core/board/what_was_measured.hpp"

namespace voqcal {

Eigen::Matrix3d CentreTrust(const LidarBoard& lidar,
                            const Eigen::Matrix3d& R_camera_lidar,
                            double sigma_centre_m) {
  if (IsWhole(lidar)) return Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d covariance =
      R_camera_lidar * lidar.pose.covariance.bottomRightCorner<3, 3>() * R_camera_lidar.transpose();
  const Eigen::Matrix3d ratio =
      Eigen::Matrix3d::Identity() + covariance / (sigma_centre_m * sigma_centre_m);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(ratio).operatorInverseSqrt();
}

std::vector<SetPose> SetPosesOf(const std::vector<const BoardSample*>& set,
                                const CameraModel& camera,
                                const Eigen::Matrix3d& R_camera_lidar,
                                const SetExtrinsicOptions& options) {
  std::vector<SetPose> poses;
  for (const BoardSample* sample : set) {
    const BoardPose& lidar = sample->lidar.pose;
    const BoardPose& seen = sample->camera.pose;
    const auto& c = seen.corners_m;
    poses.push_back({lidar.normal,
                     seen.normal,
                     lidar.centre_m,
                     seen.centre_m,
                     camera.Project(seen.centre_m),
                     ((c[1] - c[0]) + (c[2] - c[3])).normalized(),
                     ((c[2] - c[1]) + (c[3] - c[0])).normalized()});
    SetPose& pose = poses.back();
    pose.centre_trust = CentreTrust(sample->lidar, R_camera_lidar, options.sigma_centre_m);
    if (!IsWhole(sample->lidar)) {
      // The pixel has no more to say than the least trusted direction in space.
      pose.centre_px_trust =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(pose.centre_trust).eigenvalues()[0];
    }
  }
  return poses;
}

bool SetCost::operator()(const double* delta, double* residuals, double* jacobian) const {
  const LeftPerturbation at(T_camera_lidar_start, Eigen::Map<const Vector6d>(delta));
  Eigen::Map<Eigen::VectorXd> r(residuals, NumResiduals());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Residuals r_pose;
    Jacobian J_pose;
    if (!Evaluate(poses[i], at, &r_pose, jacobian != nullptr ? &J_pose : nullptr)) {
      // TinySolver does not ask whether a trial succeeded; it rejects one that costs more.
      constexpr double kRejected = 1e12;
      r.setConstant(kRejected);
      return false;
    }
    const auto row = static_cast<Eigen::Index>(kResidualsPerPose * i);
    r.segment<kResidualsPerPose>(row) = r_pose;
    if (jacobian == nullptr) continue;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6>> J(jacobian, NumResiduals(), 6);
    J.middleRows<kResidualsPerPose>(row) = J_pose;
  }
  return true;
}

bool SetCost::Evaluate(const SetPose& pose,
                       const LeftPerturbation& at,
                       Residuals* r,
                       Jacobian* J) const {
  const Eigen::Vector3d normal = at.T_camera_lidar().linear() * pose.normal_lidar;
  const Eigen::Vector3d centre_m = at.T_camera_lidar() * pose.centre_lidar_m;
  if (!camera.IsProjectable(centre_m)) return false;
  Matrix23d J_px_centre;
  const Eigen::Vector2d centre_px =
      ProjectWithJacobian(camera, centre_m, J != nullptr ? &J_px_centre : nullptr);
  *r << pose.edge_x_camera.dot(normal) / options.sigma_normal_rad,
      pose.edge_y_camera.dot(normal) / options.sigma_normal_rad,
      (normal - pose.normal_camera) / options.sigma_normal_rad,
      pose.centre_trust * ((centre_m - pose.centre_camera_m) / options.sigma_centre_m),
      pose.centre_px_trust * (centre_px - pose.centre_px) / options.sigma_centre_px;
  if (J == nullptr) return true;
  const Matrix36d J_normal = at.DirectionJacobian(normal);
  const Matrix36d J_centre = at.PointJacobian(centre_m);
  J->row(0) = pose.edge_x_camera.transpose() * J_normal / options.sigma_normal_rad;
  J->row(1) = pose.edge_y_camera.transpose() * J_normal / options.sigma_normal_rad;
  J->middleRows<3>(2) = J_normal / options.sigma_normal_rad;
  J->middleRows<3>(5) = pose.centre_trust * J_centre / options.sigma_centre_m;
  J->middleRows<2>(8) = pose.centre_px_trust * J_px_centre * J_centre / options.sigma_centre_px;
  return true;
}

}  // namespace voqcal
