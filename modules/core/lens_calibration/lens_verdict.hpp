#pragma once

#include "core/lens_calibration/lens_calibration.hpp"

namespace voqcal {

/// Fills coverage, refusal and advice by all else.
void JudgeLens(const LensCalibrationOptions& options, LensCalibration* result);

}  // namespace voqcal
