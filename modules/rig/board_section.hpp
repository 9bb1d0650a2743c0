#pragma once

#include "core/board/board_spec.hpp"
#include "files/option_section.hpp"

namespace voqcal {

/// The section board, which must be there.
void ReadBoard(OptionSection* top, BoardSpec* board);

}  // namespace voqcal
