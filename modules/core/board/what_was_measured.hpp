#pragma once

#include "core/board/board_sample.hpp"

namespace voqcal {

/// All four sides were measured.
bool IsWhole(const LidarBoard& board);

/// The board's centre is as good as measured: the sighting is whole, or the sides that were
/// measured leave it within 30 mm (1 sigma) in every direction.
bool IsCentreMeasured(const LidarBoard& board);

}  // namespace voqcal
