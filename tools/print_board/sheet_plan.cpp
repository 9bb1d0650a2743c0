#include "print_board/sheet_plan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "files/number_text.hpp"

namespace voqcal {
namespace {

struct Paper {
  const char* name;
  double width_mm;
  double height_mm;
};
constexpr Paper kPapers[] = {{"a4", 210.0, 297.0}, {"a3", 297.0, 420.0}, {"letter", 215.9, 279.4}};
constexpr char kWhole[] = "whole";

double WidthMm(const BoardSpec& board) { return 1e3 * board.width_m; }
double HeightMm(const BoardSpec& board) { return 1e3 * board.height_m; }

int NumAlong(double board_mm, double sheet_mm) {
  constexpr double kRoundingMm = 1e-6;
  const double most_mm = sheet_mm - 2 * SheetPlan::kMarginMm;
  return static_cast<int>(std::ceil((board_mm - kRoundingMm) / most_mm));
}

SheetPlan Tiled(const BoardSpec& board, double sheet_width_mm, double sheet_height_mm) {
  SheetPlan plan;
  plan.sheet_width_mm = sheet_width_mm;
  plan.sheet_height_mm = sheet_height_mm;
  plan.num_columns = NumAlong(WidthMm(board), sheet_width_mm);
  plan.num_rows = NumAlong(HeightMm(board), sheet_height_mm);
  plan.tile_width_mm = WidthMm(board) / plan.num_columns;
  plan.tile_height_mm = HeightMm(board) / plan.num_rows;
  plan.has_cover = true;
  return plan;
}

SheetPlan Whole(const BoardSpec& board) {
  constexpr double kNotesWidthMm = 215.0;  // notes and ruler, below the board
  constexpr double kNotesHeightMm = 135.0;
  SheetPlan plan;
  plan.tile_width_mm = WidthMm(board);
  plan.tile_height_mm = HeightMm(board);
  plan.sheet_width_mm = std::max(plan.tile_width_mm, kNotesWidthMm) + 2 * SheetPlan::kMarginMm;
  plan.sheet_height_mm = plan.tile_height_mm + kNotesHeightMm + 2 * SheetPlan::kMarginMm;
  return plan;
}

// A lying sheet only if it saves some.
SheetPlan FewestSheets(const BoardSpec& board, const Paper& paper) {
  const SheetPlan upright = Tiled(board, paper.width_mm, paper.height_mm);
  const SheetPlan lying = Tiled(board, paper.height_mm, paper.width_mm);
  return lying.NumTiles() < upright.NumTiles() ? lying : upright;
}

void RequirePrintable(const BoardSpec& board) {
  constexpr double kMaxSideM = 4.9;  // a PDF's page has at most 14,400 points
  if (std::max(board.width_m, board.height_m) <= kMaxSideM) return;
  throw std::runtime_error("board of " + NumberText(board.width_m) + " x " +
                           NumberText(board.height_m) +
                           " m: larger than 4.9 m cannot be printed (width_m and height_m are in "
                           "metres: are these millimetres?)");
}

}  // namespace

RectangleMm SheetPlan::TileOfFace(int row, int column) const {
  return {column * tile_width_mm, row * tile_height_mm, tile_width_mm, tile_height_mm};
}

std::vector<std::string> PaperNames() {
  std::vector<std::string> names;
  for (const Paper& paper : kPapers) names.emplace_back(paper.name);
  names.emplace_back(kWhole);
  return names;
}

SheetPlan PlanSheets(const BoardSpec& board, const std::string& paper) {
  RequirePrintable(board);
  if (paper == kWhole) return Whole(board);
  for (const Paper& known : kPapers) {
    if (paper == known.name) return FewestSheets(board, known);
  }
  throw std::invalid_argument("no paper " + paper);
}

}  // namespace voqcal
