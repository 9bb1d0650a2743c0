#pragma once

#include "core/board/board_sample.hpp"

namespace voqcal {

/// Between two frames, pixels, of the corners that both saw, up to the half-turn of a whole
/// pattern; infinite if there is none. Features of a table have no corners, and do not move by
/// them.
double LargestCornerMotionPx(const CameraBoard& a, const CameraBoard& b);

}  // namespace voqcal
