#include "core/sensor_network/sensor_pair.hpp"

#include <Eigen/Cholesky>

namespace voqcal {

// With a, b the perturbations of rotation and translation on the side `to`:
//     R' = R_rt^T Exp(-a) R_rf,   t' = R_rt^T Exp(-a) (t_rf - t_rt - b)
RelativePose::RelativePose(const Eigen::Isometry3d& T_reference_from,
                           const Eigen::Isometry3d& T_reference_to)
    : T_to_from(T_reference_to.inverse(Eigen::Isometry) * T_reference_from),
      J_from(Matrix6d::Zero()),
      J_to(Matrix6d::Zero()) {
  const Eigen::Matrix3d R_to_reference = T_reference_to.linear().transpose();
  J_from.topLeftCorner<3, 3>() = J_from.bottomRightCorner<3, 3>() = R_to_reference;
  J_to = -J_from;
  J_to.bottomLeftCorner<3, 3>() =
      R_to_reference * Skew(T_reference_from.translation() - T_reference_to.translation());
}

bool IsDefinite(const SensorPair& pair) {
  return pair.T_to_from.matrix().allFinite() && pair.covariance.allFinite() &&
         pair.covariance.llt().info() == Eigen::Success;
}

std::string PairName(const std::string& from, const std::string& to) { return from + "_" + to; }

SensorPair Reversed(const SensorPair& pair) {
  const RelativePose reversed(Eigen::Isometry3d::Identity(), pair.T_to_from);
  return {pair.to,
          pair.from,
          reversed.T_to_from,
          reversed.J_to * pair.covariance * reversed.J_to.transpose()};
}

}  // namespace voqcal
