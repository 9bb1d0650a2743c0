#pragma once

#include <optional>
#include <vector>

#include "core/assessment/diagnosis.hpp"
#include "core/board/board_sample.hpp"
#include "core/calibration/calibrate.hpp"

namespace voqcal {

/// Why samples do not agree: which answer to QuestionsAbout the rig, or to one of squares and lens
/// that the samples raise, makes most of them agree with one extrinsic, with the remedy. Nothing if
/// none makes many more agree.
std::optional<Finding> LikelyCause(const std::vector<BoardSample>& samples,
                                   const CalibrationTask& task);

}  // namespace voqcal
