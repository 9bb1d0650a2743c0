#pragma once

#include <vector>

#include "core/assessment/diagnosis.hpp"
#include "core/assessment/fault_fit.hpp"
#include "core/assessment/judged_result.hpp"

namespace voqcal {

/// Fits the samples as they would be had the rig file said something else (QuestionsAbout), and
/// appends the answer that fits best to the findings, if it fits better than chance allows, also on
/// samples left out of the fit.
/// @param plain  the fit of these samples as given, with the faults `known` that the result allows
///     for.
void JudgeQuestions(const std::vector<const BoardSample*>& samples,
                    const FaultFit& plain,
                    const std::vector<FaultParameter>& known,
                    const JudgedResult& result,
                    const DiagnosisOptions& options,
                    Diagnosis* diagnosis);

}  // namespace voqcal
