#include "core/camera/lens_errors.hpp"

#include <stdexcept>

namespace voqcal {

const char* ToString(LensError error) {
  switch (error) {
    case kFocalLength:
      return "focal_length";
    case kAspect:
      return "aspect";
    case kPrincipalPointX:
      return "principal_point_x";
    case kPrincipalPointY:
      return "principal_point_y";
    case kRadial2:
      return "radial_2";
    case kRadial4:
      return "radial_4";
    case kNumLensErrors:
      break;
  }
  throw std::logic_error("unknown LensError");
}

double LensReachPx(const CameraModel& camera) { return 0.5 * camera.width_px; }

CameraModel CorrectedCamera(const CameraModel& given, const LensErrors& errors) {
  CameraModel camera = given;
  const double reach_px = LensReachPx(given);
  camera.fx_px *= 1.0 + errors[kFocalLength] + errors[kAspect];
  camera.fy_px *= 1.0 + errors[kFocalLength] - errors[kAspect];
  camera.cx_px += reach_px * errors[kPrincipalPointX];
  camera.cy_px += reach_px * errors[kPrincipalPointY];
  // k1 and k2 come first in each lens model; they go with the powers of |q|^2 = (reach / f)^2.
  const double reach2 = reach_px * reach_px / (given.fx_px * given.fy_px);
  camera.distortion[0] += errors[kRadial2] / reach2;
  camera.distortion[1] += errors[kRadial4] / (reach2 * reach2);
  return camera;
}

}  // namespace voqcal
