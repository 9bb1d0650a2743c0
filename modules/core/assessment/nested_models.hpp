#pragma once

#include <string>
#include <vector>

#include "core/assessment/diagnosis.hpp"
#include "core/assessment/fault_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// Compares the plain fit with fits that have one more group of faults: adds the group that helps
/// most, again and again, until none is worth a word. Appends what was added to the findings, and
/// what the samples leave open, or what could hide in them, to what was not judged.
/// @param known  faults that the result allows for: they are part of every fit, and no finding.
/// @param board, camera  as given: a finding says what to give instead.
/// @param covariance  of the result.
void JudgeModels(const std::vector<FaultEquation>& equations,
                 const std::vector<FaultParameter>& known,
                 const BoardSpec& board,
                 const CameraModel& camera,
                 const Matrix6d& covariance,
                 const DiagnosisOptions& options,
                 Diagnosis* diagnosis);

/// By how many of its 95 % intervals the parameter that moves most moves: NaN if unknown.
double IntervalsOf(const Vector6d& move, const Matrix6d& covariance);

/// "it moves the result by 0.40 deg and 12 mm, 5.0 times its 95 % interval".
std::string MoveText(const Vector6d& move, const Matrix6d& covariance);

}  // namespace voqcal
