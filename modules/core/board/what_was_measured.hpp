#pragma once

#include <cstddef>
#include <vector>

#include "core/board/board_sample.hpp"

namespace voqcal {

/// All four sides were measured.
bool IsWhole(const LidarBoard& board);

/// The board's centre is as good as measured: the sighting is whole, or the sides that were
/// measured leave it within 30 mm (1 sigma) in every direction.
bool IsCentreMeasured(const LidarBoard& board);

/// Which of the pattern's corners the image shows: none if their pixels were not kept (features
/// read from a table), or are those of another pattern.
std::vector<std::size_t> SeenCorners(const BoardSample& sample, std::size_t num_corners);

}  // namespace voqcal
