#include "core/lidar_detection/cloud_axes.hpp"

#include <cstddef>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "core/lidar_detection/lidar_beams.hpp"

namespace voqcal {
namespace {

Eigen::Vector3d Towards(const Eigen::Vector3d& axis, const Eigen::Vector3d& sum_m) {
  return axis.dot(sum_m) < 0 ? Eigen::Vector3d(-axis) : axis;
}

}  // namespace

Eigen::Matrix3d CloudAxes(const std::vector<Eigen::Vector3d>& points_lidar_m) {
  constexpr std::size_t kNumPoints = 5000;  // tell the axes as well as more do
  if (points_lidar_m.size() < 3) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d scene_m2 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points_lidar_m.size(); ++i) {
    if (!IsInShare(i, kNumPoints, points_lidar_m.size())) continue;
    const Eigen::Vector3d& p_m = points_lidar_m[i];
    directions += p_m * p_m.transpose() / p_m.squaredNorm();
    scene_m2 += p_m * p_m.transpose();
    sum_m += p_m;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(directions);
  const Eigen::Vector3d z = Towards(spread.eigenvectors().col(0), sum_m);
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - z * z.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scene(across * scene_m2 * across);
  const Eigen::Vector3d x = Towards(scene.eigenvectors().col(2), sum_m);
  Eigen::Matrix3d R_axes_lidar;
  R_axes_lidar << x.transpose(), z.cross(x).transpose(), z.transpose();
  return R_axes_lidar;
}

}  // namespace voqcal
