// print_board: a rig file's board, true to scale, for a printer or a plotter.

#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/output_file.hpp"
#include "common/tool_main.hpp"
#include "files/atomic_file.hpp"
#include "print_board/board_sheets.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct PrintArgs {
  std::filesystem::path rig;
  OutputFile out;
  std::string paper;
};

PageFormat FormatOf(const std::filesystem::path& out) {
  if (out.extension() == ".pdf") return PageFormat::kPdf;
  if (out.extension() == ".svg") return PageFormat::kSvg;
  throw std::runtime_error(out.string() + ": must end with .pdf or .svg");
}

SheetPlan PlanOf(const BoardSpec& board, const std::string& paper, PageFormat format) {
  if (format == PageFormat::kPdf) return PlanSheets(board, paper.empty() ? "a4" : paper);
  if (paper.empty() || paper == "whole") return PlanSheets(board, "whole");
  throw std::runtime_error("--paper " + paper +
                           ": an SVG has one page: say --paper whole, or write a PDF");
}

void PrintBoard(const PrintArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const PageFormat format = FormatOf(args.out.path);
  const SheetPlan plan = PlanOf(rig.board, args.paper, format);
  args.out.Prepare();
  WriteFileAtomically(args.out.path, DrawBoardSheets(rig.board, rig.name, plan, format));
  std::printf("%s: %d x %d sheets%s\nPrint at 100 %% (no \"fit to page\") and measure the ruler.\n",
              args.out.path.c_str(),
              plan.num_rows,
              plan.num_columns,
              plan.has_cover ? " and a cover with rulers and notes" : "");
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Draws the board of a rig file true to scale: tiles with crop marks, or one sheet for a "
      "plotter, with a 200 mm ruler, the lines for the rig file, and which edge is up.",
      "print_board");
  voqcal::PrintArgs args;
  app.add_option("rig", args.rig, "The rig file (YAML)")->required();
  voqcal::AddOutputFile(&app, "The PDF or SVG to write", &args.out)->required();
  app.add_option("--paper",
                 args.paper,
                 "Sheets to tile the board over, or whole: one as large as the board; by default "
                 "a4 of a PDF, whole of an SVG")
      ->check(CLI::IsMember(voqcal::PaperNames()));
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::PrintBoard(args); });
}
