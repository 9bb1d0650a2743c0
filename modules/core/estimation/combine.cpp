#include "core/estimation/combine.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace voqcal {
namespace {

// The sharp one's covariance, in each direction as wide as the difference asks for.
Matrix6d Widened(const UncertainExtrinsic& robust,
                 const UncertainExtrinsic& sharp,
                 const Vector6d& difference) {
  // Directions in which both covariances are diagonal, and the robust one's is 1.
  const Matrix6d scale = robust.covariance.llt().matrixL();
  const Matrix6d inverse_scale = scale.inverse();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(
      Matrix6d(inverse_scale * sharp.covariance * inverse_scale.transpose()));
  const Vector6d apart = eigen.eigenvectors().transpose() * (inverse_scale * difference);
  Vector6d variances = eigen.eigenvalues();
  for (int i = 0; i < 6; ++i) {
    // Two that are as well known may be independent: they differ by no less than one is known.
    const double expected = std::max(1.0, variances[i] - 1.0);
    variances[i] += std::max(0.0, apart[i] * apart[i] - expected);
  }
  const Matrix6d back = scale * eigen.eigenvectors();
  return back * variances.asDiagonal() * back.transpose();
}

}  // namespace

CombinedExtrinsic Combine(const UncertainExtrinsic& robust, const UncertainExtrinsic& sharp) {
  const Vector6d difference = DifferenceLeft(robust.T_camera_lidar, sharp.T_camera_lidar);
  const Matrix6d widened = Widened(robust, sharp, difference);
  CombinedExtrinsic combined;
  const Matrix6d& K = combined.gain = robust.covariance * (robust.covariance + widened).inverse();
  const Matrix6d rest = Matrix6d::Identity() - K;
  const Matrix6d alike = K * widened;  // of both, were they independent
  const Matrix6d covariance =
      alike + rest * alike * K.transpose() + K * alike.transpose() * rest.transpose();
  combined.extrinsic.T_camera_lidar = PerturbLeft(robust.T_camera_lidar, K * difference);
  combined.extrinsic.covariance = 0.5 * (covariance + covariance.transpose());
  return combined;
}

}  // namespace voqcal
