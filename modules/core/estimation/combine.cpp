#include "core/estimation/combine.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace voqcal {

CombinedExtrinsic Combine(const UncertainExtrinsic& robust, const UncertainExtrinsic& sharp) {
  constexpr double kExpected = 6.0;  // mean of chi-square with six degrees of freedom
  const Vector6d difference = DifferenceLeft(robust.T_camera_lidar, sharp.T_camera_lidar);
  CombinedExtrinsic combined;
  const Matrix6d sum = robust.covariance + sharp.covariance;
  combined.disagreement = difference.dot(sum.ldlt().solve(difference));
  const double excess = std::max(1.0, combined.disagreement / kExpected);
  const Matrix6d widened = excess * excess * sharp.covariance;
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
