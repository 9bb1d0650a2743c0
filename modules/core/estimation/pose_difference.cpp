#include "core/estimation/pose_difference.hpp"

#include <Eigen/Cholesky>

#include "core/board/half_turn.hpp"
#include "core/board/metres_per_pixel.hpp"

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

}  // namespace

double PoseDifference::SquaredSigmas() const { return r.dot(C.llt().solve(r)); }

PoseDifference DifferenceOf(const BoardSample& sample,
                            const CameraModel& camera,
                            const Eigen::Isometry3d& T_camera_lidar,
                            const NominalNoise& nominal) {
  PoseDifference difference;
  const Eigen::Isometry3d T_by_lidar =
      T_camera_lidar * TransformFromPose(LidarPoseInCameraOrder(sample, T_camera_lidar));
  difference.r = DifferenceLeft(T_by_lidar, TransformFromPose(sample.camera.pose));
  difference.C =
      sample.camera.pose.covariance + LidarCovariance(sample, camera, T_camera_lidar, nominal);
  difference.J = -Matrix6d::Identity();
  difference.J.bottomLeftCorner<3, 3>() =
      Skew(T_camera_lidar.linear() * sample.lidar.pose.centre_m);
  return difference;
}

}  // namespace voqcal
