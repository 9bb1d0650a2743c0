#pragma once

#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"

namespace voqcal {

/// Whether a pattern offset of the board has the wrong sign, judged before any extrinsic is known.
///
/// A wrong sign puts the camera's centre of the board off by twice the offset along the board's own
/// axis. Boards that are held differently are moved in different directions, so that the distances
/// between their centres no longer agree with the lidar's. (Boards that are all held alike tell
/// nothing: the extrinsic takes the error up.)
///
/// @param samples  all, also those that consistency left out.
/// @return "board.pattern_offset_x_m 0.195 should be -0.195: ..."; empty if the signs are right, or
///     nothing tells.
std::string WrongOffsetSign(const std::vector<BoardSample>& samples, const BoardSpec& board);

}  // namespace voqcal
