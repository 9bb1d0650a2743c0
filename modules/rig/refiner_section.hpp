#pragma once

#include "core/assessment/best_extrinsic.hpp"
#include "files/yaml_reader.hpp"

namespace voqcal {

/// Reads `extrinsic_refiner`, if it is there: options not given keep their values.
void ReadExtrinsicRefiner(YamlSection* top, RefinerOptions* options);

}  // namespace voqcal
