#pragma once

#include <Eigen/Core>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// Errors of intrinsics that were given. Each tells how far it moves a point that is half the
/// image's width from the middle, as a share of that distance (the principal point's: any point).
enum LensError : Eigen::Index {
  kFocalLength,  ///< The true focal lengths are (1 + value) times those given.
  kAspect,       ///< The true fx is longer by this, the true fy shorter.
  kPrincipalPointX,
  kPrincipalPointY,
  kRadial2,  ///< The first radial coefficient: grows with the third power of the distance...
  kRadial4,  ///< ...and the second, with the fifth.
  kNumLensErrors
};
using LensErrors = Eigen::Matrix<double, kNumLensErrors, 1>;

/// "focal_length", "aspect", "principal_point_x", ...
const char* ToString(LensError error);

/// Half the image's width: what the shares are of.
double LensReachPx(const CameraModel& camera);

/// The camera as it is if `given` has these errors.
CameraModel CorrectedCamera(const CameraModel& given, const LensErrors& errors);

}  // namespace voqcal
