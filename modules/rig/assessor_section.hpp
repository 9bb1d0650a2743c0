#pragma once

#include "core/assessment/diagnosis.hpp"
#include "core/scene/scene_check.hpp"
#include "files/yaml_reader.hpp"

namespace voqcal {

/// Reads `assessor`, if it is there: options not given keep their values.
void ReadAssessor(YamlSection* top, SceneCheckOptions* scene_check, DiagnosisOptions* diagnosis);

}  // namespace voqcal
