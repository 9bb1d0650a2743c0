#pragma once

#include "rig/rig.hpp"
#include "rig/yaml_reader.hpp"

namespace voqcal {

/// Fills everything of `rig` that its file says; what is wrong becomes an error of `document`.
/// `rig->path` is given: folders are relative to it.
void ReadRigSections(YamlDocument* document, Rig* rig);

/// A transform as {quaternion_xyzw, translation_m}, the quaternion of unit length to 1e-3.
void ReadTransform(YamlSection* section, Eigen::Isometry3d* T);

}  // namespace voqcal
