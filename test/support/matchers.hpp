#pragma once

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "core/geometry/rigid.hpp"

namespace voqcal::test {

/// A transform within `rotation_tolerance_rad` and `translation_tolerance_m` of `T_expected`.
MATCHER_P3(IsNear, T_expected, rotation_tolerance_rad, translation_tolerance_m, "") {
  const Eigen::Isometry3d T_actual = arg;
  const double rotation_rad = RotationAngleBetween(T_expected.linear(), T_actual.linear());
  const double translation_m = (T_expected.translation() - T_actual.translation()).norm();
  *result_listener << "which is " << rotation_rad << " rad and " << translation_m << " m away";
  return rotation_rad <= rotation_tolerance_rad && translation_m <= translation_tolerance_m;
}

}  // namespace voqcal::test
