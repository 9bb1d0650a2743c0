#pragma once

#include <string>

#include "core/assessment/lens_correction.hpp"

namespace voqcal {

/// The section lens_correction of extrinsic.yaml, with a line break at its end. Its `camera` can
/// stand in a rig file as it is.
std::string LensCorrectionYaml(const LensCorrection& correction);

}  // namespace voqcal
