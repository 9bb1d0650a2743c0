#pragma once

#include <string>
#include <vector>

#include "core/board/board_spec.hpp"

namespace voqcal {

/// A rig file's section `board` for this board, line by line, without the pattern's optional keys
/// if all of them are as by default.
std::vector<std::string> BoardSectionLines(const BoardSpec& board);

}  // namespace voqcal
