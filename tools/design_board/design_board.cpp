// design_board: which board, and at how many places, for the sensors of a rig file.

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "common/tool_main.hpp"
#include "design_board/board_design.hpp"
#include "rig/board_lines.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct DesignArgs {
  std::filesystem::path rig;
  std::vector<double> widths_m = {0.4, 0.6, 0.8, 1.0, 1.2};
  std::vector<int> nums_poses = {8, 15, 25};
  double tolerance_mm = 5.0;
};

void PrintHead() {
  std::puts("predicted error of a lidar point, mm across the camera's view, where it is worst");
  std::printf("board, m       squares  places");
  for (const double range_m : kDesignRangesM) std::printf("  %4.0f m", range_m);
  std::printf("\n");
}

void PrintDesign(const BoardDesign& design) {
  std::printf("%5.3g x %-5.3g  %4.0f mm  %6d",
              design.board.width_m,
              design.board.height_m,
              1e3 * design.board.square_m,
              design.num_poses);
  for (const double error_mm : design.worst_errors_mm) std::printf("  %6.1f", error_mm);
  std::printf("\n");
}

void PrintRecommended(const std::vector<BoardDesign>& designs, double tolerance_mm) {
  const auto chosen = Recommended(designs, tolerance_mm);
  if (!chosen) {
    std::printf(
        "none keeps %g mm at %g m: more places, a camera of more pixels, or a lidar of more rows\n",
        tolerance_mm,
        kDesignRangesM.front());
    return;
  }
  std::printf("recommended: the smallest that keeps %g mm at %g m, held at %d places\n",
              tolerance_mm,
              kDesignRangesM.front(),
              chosen->num_poses);
  for (const std::string& line : BoardSectionLines(chosen->board)) std::puts(line.c_str());
}

void DesignBoard(const DesignArgs& args) {
  const Rig rig = LoadRig(args.rig);
  PrintHead();
  std::vector<BoardDesign> all;
  for (const double width_m : args.widths_m) {
    const BoardSpec board = Scaled(rig.board, width_m / rig.board.width_m);
    std::string why_fewer;
    for (const BoardDesign& design : PredictDesigns(rig, board, args.nums_poses, &why_fewer)) {
      PrintDesign(design);
      all.push_back(design);
    }
    if (!why_fewer.empty())
      std::printf(
          "%5.3g x %-5.3g  no more places: %s\n", board.width_m, board.height_m, why_fewer.c_str());
    std::fflush(stdout);
  }
  PrintRecommended(all, args.tolerance_mm);
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Predicts, for the camera and the lidar of a rig file (pose_guide.sensors) and boards of its "
      "pattern in several sizes, how far a lidar's point lands off, at 5, 20 and 50 m.",
      "design_board");
  voqcal::DesignArgs args;
  app.add_option("rig", args.rig, "The rig file (YAML)")->required();
  app.add_option("--widths", args.widths_m, "Widths of the board, metres, ascending")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--places", args.nums_poses, "Numbers of places, ascending")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--tolerance", args.tolerance_mm, "Millimetres at 5 m that will do")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::DesignBoard(args); });
}
