#pragma once

#include "files/yaml_reader.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Fills everything of `rig` that its file says; what is wrong becomes an error of `document`.
/// `rig->path` is given: folders are relative to it.
void ReadRigSections(YamlDocument* document, Rig* rig);

}  // namespace voqcal
