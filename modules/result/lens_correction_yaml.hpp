#pragma once

#include <string>

#include "core/assessment/lens_correction.hpp"

namespace voqcal {

/// The section lens_correction of extrinsic.yaml, with a line break at its end. Its `camera` can
/// stand in a rig file as it is.
///
/// @param which_to_take  what WhichToTake() says.
std::string LensCorrectionYaml(const LensCorrection& correction, const std::string& which_to_take);

}  // namespace voqcal
