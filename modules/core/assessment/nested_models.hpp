#pragma once

#include <vector>

#include "core/assessment/diagnosis.hpp"
#include "core/assessment/fault_model.hpp"

namespace voqcal {

/// Compares the plain fit with fits that have one more group of faults: adds the group that helps
/// most, again and again, until none is worth a word. Appends what was added to the findings, and
/// what the samples leave open to what was not judged.
void JudgeModels(const std::vector<FaultEquation>& equations,
                 const DiagnosisOptions& options,
                 Diagnosis* diagnosis);

}  // namespace voqcal
