#pragma once

#include <string>

#include "calibrate/offline_run.hpp"

namespace voqcal {

/// Where nearly every frame of a sensor, or every pair of frames, failed for one and the same
/// reason: what is most likely wrong and which key of the rig file to check, a line each. Empty if
/// nothing failed so.
std::string FailureAdvice(const OfflineRun& run);

}  // namespace voqcal
