#pragma once

#include <vector>

#include "core/assessment/diagnosis.hpp"
#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/likelihood/lidar_bias.hpp"

namespace voqcal {

/// Compares the outline that was given with its edges as the lidar measures them freely: all of
/// them, and the width against the height. Appends what differs to the findings.
/// @param range_offsets  that the lidar's ranges may have, as the result and the models say.
void JudgeOutline(const std::vector<const BoardSample*>& samples,
                  const BoardSpec& board,
                  const std::vector<BiasEstimate>& range_offsets,
                  const DiagnosisOptions& options,
                  Diagnosis* diagnosis);

}  // namespace voqcal
