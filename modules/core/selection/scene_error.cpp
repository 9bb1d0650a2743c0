#include "core/selection/scene_error.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/board/metres_per_pixel.hpp"
#include "core/estimation/left_perturbation.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

// Of the lidar's board, turned into the camera's axes.
Matrix6d LidarCovariance(const BoardSample& sample,
                         const CameraModel& camera,
                         const Eigen::Isometry3d& T_camera_lidar,
                         const NominalNoise& nominal) {
  const Eigen::Matrix3d& R = T_camera_lidar.linear();
  if (!sample.lidar.pose.covariance.isZero(0.0)) {
    Matrix6d A = Matrix6d::Zero();
    A.topLeftCorner<3, 3>() = R;
    A.bottomRightCorner<3, 3>() = R;
    return A * sample.lidar.pose.covariance * A.transpose();
  }
  const Eigen::Vector3d ray = R * sample.lidar.pose.centre_m.normalized();
  const double across_m = nominal.across_px * MetresPerPixel(sample.camera.pose, camera);
  const double along_m = nominal.along_ray_m;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.topLeftCorner<3, 3>().diagonal().setConstant(nominal.rotation_rad *
                                                          nominal.rotation_rad);
  covariance.bottomRightCorner<3, 3>() =
      across_m * across_m * Eigen::Matrix3d::Identity() +
      (along_m * along_m - across_m * across_m) * ray * ray.transpose();
  return covariance;
}

// L of one pose. Where nothing is known of the camera's noise, the lidar's is taken for all.
Matrix6d InformationOf(const BoardSample& sample,
                       const CameraModel& camera,
                       const Eigen::Isometry3d& T_camera_lidar,
                       const NominalNoise& nominal) {
  const Matrix6d covariance =
      sample.camera.pose.covariance + LidarCovariance(sample, camera, T_camera_lidar, nominal);
  Matrix6d J = -Matrix6d::Identity();
  J.bottomLeftCorner<3, 3>() = Skew(T_camera_lidar.linear() * sample.lidar.pose.centre_m);
  return J.transpose() * covariance.llt().solve(J);
}

}  // namespace

SceneErrorPredictor::SceneErrorPredictor(const std::vector<BoardSample>& scene,
                                         const CameraModel& camera,
                                         const Eigen::Isometry3d& T_camera_lidar,
                                         const NominalNoise& nominal) {
  const LeftPerturbation at(T_camera_lidar, Vector6d::Zero());
  int num_seen = 0;
  for (const BoardSample& sample : scene) {
    information_.push_back(InformationOf(sample, camera, T_camera_lidar, nominal));
    const Eigen::Vector3d centre_camera_m = T_camera_lidar * sample.lidar.pose.centre_m;
    if (!camera.IsInFront(centre_camera_m) || !camera.IsInFront(sample.camera.pose.centre_m)) {
      continue;
    }
    Matrix23d J_px_centre;
    ProjectWithJacobian(camera, centre_camera_m, &J_px_centre);
    const Eigen::Matrix<double, 2, 6> P_m = MetresPerPixel(sample.camera.pose, camera) *
                                            J_px_centre * at.PointJacobian(centre_camera_m);
    scene_m2_ += P_m.transpose() * P_m;
    ++num_seen;
  }
  if (num_seen > 0) scene_m2_ /= num_seen;
}

double SceneErrorPredictor::PredictMm(const std::array<int, 3>& poses) const {
  Matrix6d information = Matrix6d::Zero();
  for (const int pose : poses) information += information_[static_cast<std::size_t>(pose)];
  const Eigen::LLT<Matrix6d> cholesky(information);
  if (cholesky.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return kMmPerM * std::sqrt(cholesky.solve(scene_m2_).trace());
}

}  // namespace voqcal
