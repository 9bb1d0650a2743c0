#pragma once

#include <string>

#include "core/board/board_spec.hpp"
#include "print_board/canvas.hpp"
#include "print_board/sheet_plan.hpp"

namespace voqcal {

/// The board true to scale, as the bytes of a file: rulers that show whether the printer keeps it,
/// notes, then a page for each tile with crop marks. The same board and plan give the same bytes.
///
/// @param name  of the rig, which every sheet bears.
/// @param format  an SVG has one page: a plan of one sheet without cover.
std::string DrawBoardSheets(const BoardSpec& board,
                            const std::string& name,
                            const SheetPlan& plan,
                            PageFormat format);

}  // namespace voqcal
