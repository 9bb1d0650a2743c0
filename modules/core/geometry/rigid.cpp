#include "core/geometry/rigid.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/SVD>

namespace voqcal {

Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d S;
  S << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return S;
}

Eigen::Matrix3d ExpSO3(const Eigen::Vector3d& omega_rad) {
  const double angle_rad = omega_rad.norm();
  if (angle_rad < 1e-12) return Eigen::Matrix3d::Identity() + Skew(omega_rad);
  return Eigen::AngleAxisd(angle_rad, omega_rad / angle_rad).toRotationMatrix();
}

Eigen::Vector3d LogSO3(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sin_half = q.vec().norm();
  // angle / sin(angle / 2), by its limit where the quotient is 0 / 0.
  const double scale = sin_half < 1e-12 ? 2.0 : 2.0 * std::atan2(sin_half, q.w()) / sin_half;
  return scale * q.vec();
}

Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& M) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Vector3d signs(1, 1, handedness);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Eigen::Isometry3d PerturbLeft(const Eigen::Isometry3d& T_target_source, const Vector6d& delta) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3(delta.head<3>()) * T_target_source.linear();
  T.translation() = T_target_source.translation() + delta.tail<3>();
  return T;
}

Vector6d DifferenceLeft(const Eigen::Isometry3d& T_from, const Eigen::Isometry3d& T_to) {
  Vector6d delta;
  delta << LogSO3(T_to.linear() * T_from.linear().transpose()),
      T_to.translation() - T_from.translation();
  return delta;
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double RotationAngleBetween(const Eigen::Matrix3d& R_a, const Eigen::Matrix3d& R_b) {
  return LogSO3(R_b * R_a.transpose()).norm();
}

Eigen::Matrix3d MeanRotation(const std::vector<Eigen::Matrix3d>& rotations) {
  if (rotations.empty()) throw std::invalid_argument("MeanRotation: no rotations");
  constexpr int kMaxIterations = 50;
  Eigen::Matrix3d mean = rotations.front();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::Vector3d step_rad = Eigen::Vector3d::Zero();
    for (const Eigen::Matrix3d& R : rotations) step_rad += LogSO3(R * mean.transpose());
    step_rad /= static_cast<double>(rotations.size());
    mean = NearestRotation(ExpSO3(step_rad) * mean);
    if (step_rad.norm() < 1e-15) break;
  }
  return mean;
}

}  // namespace voqcal
