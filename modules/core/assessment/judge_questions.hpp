#pragma once

#include <vector>

#include "core/assessment/diagnosis.hpp"
#include "core/assessment/fault_model.hpp"

namespace voqcal {

/// Fits the samples as they would be had the rig file said something else (QuestionsAbout), and
/// appends the answer that fits best to the findings, if it fits better than chance allows, also on
/// samples left out of the fit.
/// @param plain  the fit of these samples as given, with the faults `known` that the result allows
///     for.
/// @param T_camera_lidar  that its values are about.
void JudgeQuestions(const std::vector<const BoardSample*>& samples,
                    const FaultFit& plain,
                    const std::vector<FaultParameter>& known,
                    const BoardSpec& board,
                    const CameraModel& camera,
                    const Eigen::Isometry3d& T_camera_lidar,
                    const Matrix6d& covariance,
                    const DiagnosisOptions& options,
                    Diagnosis* diagnosis);

}  // namespace voqcal
