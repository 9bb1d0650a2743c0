#pragma once

#include <string>
#include <vector>

#include "core/board/board_spec.hpp"

namespace voqcal {

/// A rectangle in mm, x to the right, y downwards.
struct RectangleMm {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// How a board is laid out on paper: its face, seen from the front with y up, in equal tiles, one a
/// sheet. Around a tile there is a margin, which the neighbouring tile's face reaches into.
struct SheetPlan {
  double sheet_width_mm = 0.0;
  double sheet_height_mm = 0.0;
  double tile_width_mm = 0.0;
  double tile_height_mm = 0.0;
  int num_columns = 1;
  int num_rows = 1;
  bool has_cover = false;  ///< Rulers and notes are on a sheet of their own, not below the board.

  /// From the edge of the sheet to the tile: printers leave up to 6 mm white.
  static constexpr double kMarginMm = 15.0;
  /// How far the face goes on beyond the tile: a cut that is off by less shows no white.
  static constexpr double kBleedMm = 4.0;

  int NumTiles() const { return num_columns * num_rows; }

  /// The part of the face that a tile shows; (0, 0) is the face's upper left corner.
  RectangleMm TileOfFace(int row, int column) const;

  /// Where the tile lies on its sheet.
  RectangleMm TileOnSheet() const { return {kMarginMm, kMarginMm, tile_width_mm, tile_height_mm}; }
};

/// "a4", "a3", "letter" and "whole", one sheet as large as the board.
std::vector<std::string> PaperNames();

/// As few sheets as will do, upright or lying.
///
/// @param paper  one of PaperNames().
/// @throws std::runtime_error if the board takes more sheets than anyone would glue together, or is
///     larger than a PDF's page may be.
SheetPlan PlanSheets(const BoardSpec& board, const std::string& paper);

}  // namespace voqcal
