#pragma once

#include "core/board/board_spec.hpp"
#include "files/option_section.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// The section board, which must be there. Whose plate's size may be missing, and is, gets the
/// least plate that the pattern fits on.
/// @return whether the size is given.
bool ReadBoard(OptionSection* top, PlateInRig plate, BoardSpec* board);

}  // namespace voqcal
