#pragma once

#include "files/yaml_reader.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Fills everything of `rig` that its file says; what is wrong becomes an error of `document`.
/// `rig->path` is given: folders are relative to it. With `lens`, the camera's numbers may be
/// missing.
void ReadRigSections(YamlDocument* document, Rig* rig, LensInRig* lens = nullptr);

}  // namespace voqcal
