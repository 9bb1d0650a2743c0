#pragma once

#include "core/assessment/diagnosis.hpp"
#include "core/scene/scene_check.hpp"
#include "files/option_section.hpp"

namespace voqcal {

/// Reads `assessor`, if it is there: options not given keep their values.
void ReadAssessor(OptionSection* top, SceneCheckOptions* scene_check, DiagnosisOptions* diagnosis);

}  // namespace voqcal
