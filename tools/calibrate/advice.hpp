#pragma once

#include <string>

#include "calibrate/offline_run.hpp"

namespace voqcal {

/// What is likely wrong, and which key of the rig file to check, where nearly every frame of a
/// module counts as `reason` (behind which a detail may stand); empty if there is nothing to say of
/// it.
std::string AdviceOn(const std::string& module, const std::string& reason);

/// Where nearly every frame of a sensor, or every pair of frames, failed for one and the same
/// reason: the advice on it, a line each. Empty if nothing failed so.
std::string FailureAdvice(const OfflineRun& run);

}  // namespace voqcal
