#include "core/estimation/pose_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/estimation/is_regular.hpp"

namespace voqcal {
namespace {

constexpr double kDimensions = 6.0;
constexpr double kCauchyWidth = 2.385;  // 95 % efficient on normal noise

// Gauss-Newton's equations, each pose with its robust weight.
struct Equations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d pull = Vector6d::Zero();
  double sum_weighted = 0.0;  // of the squared sigmas
  double sum_weights = 0.0;
};

Equations EquationsAt(const std::vector<const BoardSample*>& samples,
                      const CameraModel& camera,
                      const Eigen::Isometry3d& T_camera_lidar,
                      const NominalNoise& nominal) {
  Equations equations;
  for (const BoardSample* sample : samples) {
    const PoseDifference d = DifferenceOf(*sample, camera, T_camera_lidar, nominal);
    const Eigen::LLT<Matrix6d> cholesky(d.C);
    const Vector6d whitened = cholesky.solve(d.r);
    const double squared = d.r.dot(whitened);
    const double weight = 1.0 / (1.0 + squared / (kDimensions * kCauchyWidth * kCauchyWidth));
    equations.information += weight * d.J.transpose() * cholesky.solve(d.J);
    equations.pull -= weight * d.J.transpose() * whitened;
    equations.sum_weighted += weight * squared;
    equations.sum_weights += weight;
  }
  return equations;
}

}  // namespace

PoseFit FitPoses(const std::vector<const BoardSample*>& samples,
                 const CameraModel& camera,
                 const Eigen::Isometry3d& T_camera_lidar_start,
                 const NominalNoise& nominal) {
  constexpr int kMaxIterations = 100;
  constexpr double kConverged = 1e-9;  // radians and metres
  PoseFit fit;
  fit.T_camera_lidar = T_camera_lidar_start;
  for (int i = 0; i < kMaxIterations && !fit.is_usable; ++i) {
    const Equations equations = EquationsAt(samples, camera, fit.T_camera_lidar, nominal);
    if (!IsRegular(equations.information)) return fit;
    const Eigen::LLT<Matrix6d> cholesky(equations.information);
    const Vector6d step = cholesky.solve(equations.pull);
    if (!step.allFinite()) return fit;
    fit.T_camera_lidar = PerturbLeft(fit.T_camera_lidar, step);
    const double spread = equations.sum_weighted / (kDimensions * equations.sum_weights);
    fit.covariance = std::max(1.0, spread) * cholesky.solve(Matrix6d::Identity());
    fit.is_usable = step.norm() < kConverged;
  }
  return fit;
}

}  // namespace voqcal
