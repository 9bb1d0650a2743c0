#pragma once

#include <Eigen/Geometry>

#include "core/geometry/rigid.hpp"

namespace voqcal {

/// An extrinsic and how well it is known.
struct UncertainExtrinsic {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< Of [rotation_rad; translation_m], left side.
};

/// Two estimates from the same samples as one.
struct CombinedExtrinsic {
  UncertainExtrinsic extrinsic;
  /// How much of the way from the first to the second it went: delta = gain * difference.
  Matrix6d gain = Matrix6d::Zero();
  /// Their squared difference over the sum of their covariances: 6 is expected.
  double disagreement = 0;
};

/// Weighs two estimates by their covariances: `robust` assumes little, `sharp` more. As in
/// Hausman's test (Specification tests in econometrics, 1978), a difference beyond what the
/// covariances expect says that what `sharp` assumes is wrong: its covariance is widened by the
/// square of the excess, so that it counts less the less they agree. Both saw the same samples: the
/// covariance takes them for fully correlated as far as they tell the same.
CombinedExtrinsic Combine(const UncertainExtrinsic& robust, const UncertainExtrinsic& sharp);

}  // namespace voqcal
