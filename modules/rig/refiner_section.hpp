#pragma once

#include "core/assessment/best_extrinsic.hpp"
#include "files/option_section.hpp"

namespace voqcal {

/// Reads `extrinsic_refiner`, if it is there: options not given keep their values.
void ReadExtrinsicRefiner(OptionSection* top, RefinerOptions* options);

}  // namespace voqcal
