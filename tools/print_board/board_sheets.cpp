#include "print_board/board_sheets.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/camera_detection/calibration_target.hpp"
#include "core/format.hpp"
#include "rig/board_lines.hpp"

namespace voqcal {
namespace {

constexpr double kThinMm = 0.1;
constexpr double kSmallTextMm = 3.0;
constexpr double kTextMm = 3.6;
constexpr double kLineMm = 5.2;
constexpr double kLabelMm = SheetPlan::kBleedMm + 1.5;  // from a tile to what is said of it

/// Dark cells on the face, from its upper left corner; neighbours along x in one piece.
std::vector<RectangleMm> DarkParts(const BoardSpec& board) {
  const PrintedPattern printed = TargetOf(board).print(board);
  const auto x_mm = [&](int line) { return 1e3 * (printed.x_lines_m[line] + board.width_m / 2); };
  const auto y_mm = [&](int line) { return 1e3 * (board.height_m / 2 - printed.y_lines_m[line]); };
  std::vector<RectangleMm> parts;
  for (int j = 0; j < printed.NumCellsY(); ++j) {
    for (int i = 0; i < printed.NumCellsX(); ++i) {
      const int begin = i;
      while (i < printed.NumCellsX() && printed.is_dark[j * printed.NumCellsX() + i]) ++i;
      if (i == begin) continue;
      parts.push_back({x_mm(begin), y_mm(j + 1), x_mm(i) - x_mm(begin), y_mm(j) - y_mm(j + 1)});
    }
  }
  return parts;
}

RectangleMm Intersection(const RectangleMm& a, const RectangleMm& b) {
  const double left = std::max(a.left, b.left);
  const double top = std::max(a.top, b.top);
  return {left,
          top,
          std::min(a.left + a.width, b.left + b.width) - left,
          std::min(a.top + a.height, b.top + b.height) - top};
}

RectangleMm Grown(const RectangleMm& one, double by_mm) {
  return {one.left - by_mm, one.top - by_mm, one.width + 2 * by_mm, one.height + 2 * by_mm};
}

/// At each corner two lines that point at it, clear of what is printed around the tile.
void DrawCropMarks(const RectangleMm& tile, Canvas* canvas) {
  constexpr double kBeginMm = SheetPlan::kBleedMm + 0.5;
  constexpr double kEndMm = kBeginMm + 5.0;
  for (const double right : {-1.0, 1.0}) {
    for (const double down : {-1.0, 1.0}) {
      const double x = right < 0 ? tile.left : tile.left + tile.width;
      const double y = down < 0 ? tile.top : tile.top + tile.height;
      canvas->Line(x + right * kBeginMm, y, x + right * kEndMm, y, kThinMm);
      canvas->Line(x, y + down * kBeginMm, x, y + down * kEndMm, kThinMm);
    }
  }
}

/// Ticks each 5 mm, numbers each 50 mm, from (x_mm, y_mm) to the right or downwards.
void DrawRuler(int length_mm, bool is_across, double x_mm, double y_mm, Canvas* canvas) {
  const auto line = [&](double from_along, double from_aside, double to_along, double to_aside) {
    canvas->Line(x_mm + (is_across ? from_along : from_aside),
                 y_mm + (is_across ? from_aside : from_along),
                 x_mm + (is_across ? to_along : to_aside),
                 y_mm + (is_across ? to_aside : to_along),
                 kThinMm);
  };
  line(0, 0, length_mm, 0);
  for (int mm = 0; mm <= length_mm; mm += 5) {
    line(mm, 0, mm, mm % 50 == 0 ? 6 : mm % 10 == 0 ? 4 : 2);
    if (mm % 50 != 0) continue;
    const double number_x_mm = x_mm + (is_across ? mm : 12);
    const double number_y_mm = y_mm + (is_across ? 10 : mm + 1);
    canvas->CentredText(number_x_mm, number_y_mm, kSmallTextMm, std::to_string(mm) + " mm");
  }
}

std::vector<std::string> HowToCut(const SheetPlan& plan) {
  if (!plan.has_cover) {
    return {Format("3. The board is what lies between the crop marks: %.1f x %.1f mm. Cut it out.",
                   plan.tile_width_mm,
                   plan.tile_height_mm)};
  }
  return {
      Format("3. %d x %d sheets (rows x columns), %.1f x %.1f mm between the crop marks of each.",
             plan.num_rows,
             plan.num_columns,
             plan.tile_width_mm,
             plan.tile_height_mm),
      "    Cut off right and lower margins at the marks, lay each sheet over the next one's",
      "    margin so that the marks meet, and cut around the whole."};
}

std::vector<std::string> WhatIsUp(const BoardSpec& board) {
  if (!TargetOf(board).has_half_turn(board)) {
    return {"5. The edge that is on top here is up: height_m runs upwards."};
  }
  return {"5. Upside down it looks the same: write \"up\" on the back of the edge that is on top",
          "    here, and hold it this way up in every pose."};
}

std::vector<std::string> Notes(const BoardSpec& board, const SheetPlan& plan) {
  std::vector<std::string> lines = {
      "1. Print at 100 % (\"actual size\", not \"fit to page\"), on matt paper.",
      "2. Measure the ruler. If it is not right, print anew without scaling."};
  const auto add = [&lines](const std::vector<std::string>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
  };
  add(HowToCut(plan));
  lines.push_back(Format("4. Glue it to a stiff flat plate of %.4g x %.4g m, edge on edge.",
                         board.width_m,
                         board.height_m));
  add(WhatIsUp(board));
  lines.emplace_back(
      "6. Measure the plate and a long row of squares or tags, and correct the rig file:");
  return lines;
}

/// Notes and the rig file's lines. @return the base line below them.
double DrawNotes(
    const BoardSpec& board, const SheetPlan& plan, double x_mm, double y_mm, Canvas* canvas) {
  for (const std::string& line : Notes(board, plan)) {
    canvas->Text(x_mm, y_mm, kTextMm, line);
    y_mm += kLineMm;
  }
  y_mm += 1;
  for (const std::string& line : BoardSectionLines(board)) {
    canvas->FixedWidthText(x_mm + 6, y_mm, kTextMm, line);
    y_mm += kLineMm - 0.6;
  }
  return y_mm;
}

void DrawTile(const std::vector<RectangleMm>& dark,
              const SheetPlan& plan,
              int row,
              int column,
              Canvas* canvas) {
  const RectangleMm of_face = plan.TileOfFace(row, column);
  const RectangleMm face{
      0, 0, plan.num_columns * plan.tile_width_mm, plan.num_rows * plan.tile_height_mm};
  const RectangleMm on_sheet = plan.TileOnSheet();
  canvas->DrawAt(on_sheet.left - of_face.left, on_sheet.top - of_face.top, 1, [&] {
    canvas->FillRectangles(dark, Intersection(face, Grown(of_face, SheetPlan::kBleedMm)));
  });
  DrawCropMarks(on_sheet, canvas);
}

std::string TileLabel(const SheetPlan& plan, int row, int column) {
  const std::string up = "this edge is up";
  return plan.NumTiles() == 1 ? up : Format("row %d, column %d; ", row + 1, column + 1) + up;
}

/// In the margins, clear of the face.
void DrawTileLabels(
    const SheetPlan& plan, int row, int column, const std::string& title, Canvas* canvas) {
  const RectangleMm tile = plan.TileOnSheet();
  canvas->Text(tile.left + 3, tile.top - kLabelMm, kSmallTextMm, TileLabel(plan, row, column));
  canvas->Text(
      tile.left + 3, tile.top + tile.height + kLabelMm + kSmallTextMm * 0.7, kSmallTextMm, title);
}

/// The face, small, with its tiles as they are numbered, and what is up.
void DrawMiniature(const std::vector<RectangleMm>& dark,
                   const SheetPlan& plan,
                   const RectangleMm& place,
                   Canvas* canvas) {
  const RectangleMm face{
      0, 0, plan.num_columns * plan.tile_width_mm, plan.num_rows * plan.tile_height_mm};
  const double scale = std::min(place.width / face.width, place.height / face.height);
  canvas->DrawAt(place.left, place.top, scale, [&] {
    canvas->FillRectangles(dark, face);
    for (int row = 0; row < plan.num_rows; ++row) {
      for (int column = 0; column < plan.num_columns; ++column) {
        canvas->Outline(plan.TileOfFace(row, column), 0.2 / scale);
      }
    }
  });
  const double middle_mm = place.left + face.width * scale / 2;
  canvas->CentredText(middle_mm, place.top - 2, kSmallTextMm, "up");
}

/// An upright sheet with all that is to be known before cutting.
void DrawCover(const BoardSpec& board,
               const std::vector<RectangleMm>& dark,
               const std::string& title,
               const SheetPlan& plan,
               Canvas* canvas) {
  constexpr double kLeftMm = SheetPlan::kMarginMm;
  const double width_mm = std::min(plan.sheet_width_mm, plan.sheet_height_mm);
  const double height_mm = std::max(plan.sheet_width_mm, plan.sheet_height_mm);
  canvas->BeginPage(width_mm, height_mm);
  canvas->Text(kLeftMm, 20, 5, title);
  const double notes_end_mm = DrawNotes(board, plan, kLeftMm, 30, canvas);
  const double across_mm = height_mm - 32;  // where the ruler across is
  DrawRuler(200, false, width_mm - 28, 32, canvas);
  DrawRuler(150, true, kLeftMm, across_mm, canvas);
  const double top_mm = notes_end_mm + 6;
  DrawMiniature(dark, plan, {kLeftMm + 6, top_mm, width_mm - 80, across_mm - 8 - top_mm}, canvas);
}

void DrawTilePage(const std::vector<RectangleMm>& dark,
                  const SheetPlan& plan,
                  int row,
                  int column,
                  const std::string& title,
                  Canvas* canvas) {
  canvas->BeginPage(plan.sheet_width_mm, plan.sheet_height_mm);
  DrawTile(dark, plan, row, column, canvas);
  DrawTileLabels(plan, row, column, title, canvas);
}

std::string Title(const BoardSpec& board, const std::string& name) {
  return Format("%s: %s, %.4g x %.4g m, %s %.4g",
                name.c_str(),
                board.pattern.c_str(),
                board.width_m,
                board.height_m,
                SideKeyOf(board).c_str(),
                board.square_m);
}

}  // namespace

std::string DrawBoardSheets(const BoardSpec& board,
                            const std::string& name,
                            const SheetPlan& plan,
                            PageFormat format) {
  const std::vector<RectangleMm> dark = DarkParts(board);
  const std::string title = Title(board, name);
  Canvas canvas(format);
  if (plan.has_cover) DrawCover(board, dark, title, plan, &canvas);
  for (int row = 0; row < plan.num_rows; ++row) {
    for (int column = 0; column < plan.num_columns; ++column) {
      DrawTilePage(dark, plan, row, column, title, &canvas);
    }
  }
  if (!plan.has_cover) {
    const RectangleMm tile = plan.TileOnSheet();
    const double below_mm = tile.top + tile.height + 20;
    DrawRuler(200, true, tile.left, below_mm, &canvas);
    DrawNotes(board, plan, tile.left, below_mm + 20, &canvas);
  }
  return canvas.Finish();
}

}  // namespace voqcal
