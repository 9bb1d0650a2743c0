#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/guided_board.hpp"
#include "voqcal/simulated_board_t.hpp"

namespace voqcal {

/// @param epoch_utime  of the simulation's time 0.
simulated_board_t ToMessage(const GuidedBoard& board, std::int64_t epoch_utime);

/// @throws MessageError if there is no stop.
std::vector<BoardStop> StopsFromMessage(const simulated_board_t& message, std::int64_t epoch_utime);

}  // namespace voqcal
