#pragma once

#include <vector>

#include "core/assessment/diagnosis.hpp"
#include "core/assessment/fault_fit.hpp"
#include "core/assessment/judged_result.hpp"

namespace voqcal {

/// Compares the plain fit with fits that have one more group of faults: adds the group that helps
/// most, again and again, until none is worth a word. Appends what was added to the findings, and
/// what the samples leave open, or what could hide in them, to what was not judged.
/// @param known  faults that the result allows for: they are part of every fit, and no finding.
/// @return the fit with all that was found, the principal point aside; not usable if none is.
FaultFit JudgeModels(const std::vector<FaultEquation>& equations,
                     const std::vector<FaultParameter>& known,
                     const JudgedResult& result,
                     const DiagnosisOptions& options,
                     Diagnosis* diagnosis);

}  // namespace voqcal
