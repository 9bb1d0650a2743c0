#pragma once

#include <Eigen/Geometry>

#include "rig/yaml_reader.hpp"

namespace voqcal {

/// A transform as {quaternion_xyzw, translation_m}, the quaternion of unit length to 1e-3.
void ReadTransform(YamlSection* section, Eigen::Isometry3d* T);

}  // namespace voqcal
