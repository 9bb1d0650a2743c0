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
};

/// Weighs two estimates by their covariances: `robust` assumes little, `sharp` more. Both saw the
/// same samples: if what `sharp` assumes is right, their difference has the difference of their
/// variances (Hausman 1978, "Specification tests in econometrics", Econometrica 46), and were they
/// independent, the sum. Beyond the variance of `robust`, in each of the six directions by itself,
/// its square is added to the variance of `sharp`, the moment estimate of DerSimonian and Laird
/// 1986, "Meta-analysis in clinical trials", Controlled Clinical Trials 7: it counts less the less
/// they agree. The covariance takes the two for fully
/// correlated as far as they tell the same.
CombinedExtrinsic Combine(const UncertainExtrinsic& robust, const UncertainExtrinsic& sharp);

}  // namespace voqcal
