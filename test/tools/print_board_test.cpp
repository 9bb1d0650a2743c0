// What print_board draws, measured in pixels of the rendered page, at 600 dpi.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/format.hpp"
#include "print_board/board_sheets.hpp"
#include "rig/board_lines.hpp"
#include "rig/rig.hpp"
#include "support/temporary_folder.hpp"

// Fontconfig keeps the fonts that it found until the process ends, by way of cairo.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kPixelsPerMm = 600 / 25.4;
constexpr int kHalf = 28;  // of a patch that is looked at, pixels: 1.2 mm

BoardSpec SmallChessboard() {
  BoardSpec board;
  board.width_m = 0.30;
  board.height_m = 0.21;
  board.square_m = 0.043;
  board.num_corners_x = 4;
  board.num_corners_y = 3;
  board.pattern_offset_x_m = 0.004;
  board.pattern_offset_y_m = -0.003;
  return board;
}

BoardSpec SmallCharuco() {
  BoardSpec board = SmallChessboard();
  board.pattern = "charuco";
  board.marker_m = 0.031;
  board.num_corners_x = 3;
  return board;
}

BoardSpec SmallAprilGrid() {
  BoardSpec board = SmallChessboard();
  board.pattern = "aprilgrid";
  board.square_m = 0.043;
  board.gap_squares = 0.3;
  board.num_corners_x = 2 * 4;
  board.num_corners_y = 2 * 3;
  return board;
}

/// A PDF, of which pdftoppm (poppler-utils) renders parts.
class Pages {
 public:
  explicit Pages(const std::string& pdf) { folder_.Write("board.pdf", pdf); }

  /// The pixels around a place on a page (from 1).
  cv::Mat Around(int page, const Eigen::Vector2d& place_mm) const {
    const Eigen::Vector2i first = FirstPixel(place_mm);
    const std::string out = (folder_.path() / "part").string();
    const std::string command =
        Format("pdftoppm -r 600 -gray -singlefile -f %d -l %d -x %d -y %d -W %d -H %d %s %s",
               page,
               page,
               first.x(),
               first.y(),
               2 * kHalf,
               2 * kHalf,
               (folder_.path() / "board.pdf").c_str(),
               out.c_str());
    if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
    return cv::imread(out + ".pgm", cv::IMREAD_GRAYSCALE);
  }

  static Eigen::Vector2i FirstPixel(const Eigen::Vector2d& place_mm) {
    return (place_mm * kPixelsPerMm).array().round().cast<int>() - kHalf;
  }

 private:
  test::TemporaryFolder folder_;
};

/// Where a row of pixels changes from its first shade to its last, from its beginning.
double Step(const cv::Mat& row) {
  const double first = row.at<unsigned char>(0);
  const double last = row.at<unsigned char>(static_cast<int>(row.total()) - 1);
  if (std::abs(first - last) < 200) return NAN;
  double sum = 0;
  for (int i = 0; i < static_cast<int>(row.total()); ++i) {
    sum += (row.at<unsigned char>(i) - last) / (first - last);
  }
  return sum;
}

/// The middle of the dark line that crosses a row of pixels, from its beginning.
double LineMiddle(const cv::Mat& row) {
  double sum = 0;
  double weighted = 0;
  for (int i = 0; i < static_cast<int>(row.total()); ++i) {
    const double dark = 255 - row.at<unsigned char>(i);
    sum += dark;
    weighted += dark * (i + 0.5);
  }
  return weighted / sum;
}

/// Where four shades meet, on the page: on both sides of it each edge is looked at.
Eigen::Vector2d MeasuredCornerMm(const Pages& pages, int page, const Eigen::Vector2d& near_mm) {
  const cv::Mat patch = pages.Around(page, near_mm);
  const int last = 2 * kHalf - 1;
  const cv::Mat columns = patch.t();
  const Eigen::Vector2d in_patch_px((Step(patch.row(0)) + Step(patch.row(last))) / 2,
                                    (Step(columns.row(0)) + Step(columns.row(last))) / 2);
  return (Pages::FirstPixel(near_mm).cast<double>() + in_patch_px) / kPixelsPerMm;
}

/// How far the corners of a pattern are from where the crop marks of their tiles put them.
double LargestErrorMm(const BoardSpec& board, const std::string& paper) {
  const SheetPlan plan = PlanSheets(board, paper);
  const Pages pages(DrawBoardSheets(board, "test", plan, PageFormat::kPdf));
  double largest_mm = 0;
  for (const Eigen::Vector3d& corner : board.InnerCornersBoardM()) {
    const Eigen::Vector2d face_mm(1e3 * (corner.x() + board.width_m / 2),
                                  1e3 * (board.height_m / 2 - corner.y()));
    const int column = static_cast<int>(face_mm.x() / plan.tile_width_mm);
    const int row = static_cast<int>(face_mm.y() / plan.tile_height_mm);
    const RectangleMm of_face = plan.TileOfFace(row, column);
    const RectangleMm on_sheet = plan.TileOnSheet();
    const Eigen::Vector2d sheet_mm =
        face_mm + Eigen::Vector2d(on_sheet.left - of_face.left, on_sheet.top - of_face.top);
    const int page = (plan.has_cover ? 2 : 1) + row * plan.num_columns + column;
    const double error_mm = (MeasuredCornerMm(pages, page, sheet_mm) - sheet_mm).norm();
    if (std::isnan(error_mm)) return error_mm;
    largest_mm = std::max(largest_mm, error_mm);
  }
  return largest_mm;
}

TEST(PrintBoard, EveryCornerIsWhereItBelongs) {
  EXPECT_LT(LargestErrorMm(SmallChessboard(), "a4"), 0.1);
  EXPECT_LT(LargestErrorMm(SmallCharuco(), "whole"), 0.1);
  EXPECT_LT(LargestErrorMm(SmallAprilGrid(), "whole"), 0.1);
}

TEST(PrintBoard, CropMarksAndRulerAreTrueToScale) {
  const BoardSpec board = SmallChessboard();
  const SheetPlan plan = PlanSheets(board, "a4");
  ASSERT_EQ(plan.NumTiles(), 2);
  const Pages pages(DrawBoardSheets(board, "test", plan, PageFormat::kPdf));
  const auto x_mm = [&](double near_mm) {
    const Eigen::Vector2d place_mm(near_mm, 8);  // beyond the face, in the upper margin
    const cv::Mat patch = pages.Around(2, place_mm);
    return (Pages::FirstPixel(place_mm).x() + LineMiddle(patch.row(kHalf))) / kPixelsPerMm;
  };
  const RectangleMm tile = plan.TileOnSheet();
  EXPECT_NEAR(x_mm(tile.left), tile.left, 0.1);
  EXPECT_NEAR(x_mm(tile.left + tile.width), tile.left + tile.width, 0.1);

  const auto y_mm = [&](double near_mm) {
    const Eigen::Vector2d place_mm(210 - 28 + 1.5, near_mm);  // on the ticks of the cover's ruler
    const cv::Mat patch = pages.Around(1, place_mm).t();
    return (Pages::FirstPixel(place_mm).y() + LineMiddle(patch.row(kHalf))) / kPixelsPerMm;
  };
  EXPECT_NEAR(y_mm(232) - y_mm(32), 200, 0.1);
}

TEST(PrintBoard, TheSameBoardGivesTheSameBytes) {
  const SheetPlan plan = PlanSheets(SmallCharuco(), "a3");
  const std::string pdf = DrawBoardSheets(SmallCharuco(), "test", plan, PageFormat::kPdf);
  EXPECT_EQ(pdf, DrawBoardSheets(SmallCharuco(), "test", plan, PageFormat::kPdf));
  EXPECT_THAT(pdf, Not(HasSubstr("CreationDate")));
}

TEST(PrintBoard, AnSvgSaysItsSizeInPoints) {
  const SheetPlan plan = PlanSheets(SmallChessboard(), "whole");
  const std::string svg = DrawBoardSheets(SmallChessboard(), "test", plan, PageFormat::kSvg);
  // 330 mm: the board and its margins.
  EXPECT_THAT(svg, HasSubstr("width=\"935.43"));
  EXPECT_THAT(svg, ::testing::ContainsRegex("width=\"935.43[0-9]*pt\""));
}

TEST(PlanSheets, TakesAsFewEqualTilesAsWillDo) {
  const SheetPlan a4 = PlanSheets(SmallChessboard(), "a4");
  EXPECT_EQ(a4.num_columns, 2);
  EXPECT_EQ(a4.num_rows, 1);
  EXPECT_DOUBLE_EQ(a4.tile_width_mm, 150);
  const SheetPlan a3 = PlanSheets(SmallChessboard(), "a3");
  EXPECT_EQ(a3.NumTiles(), 1);
  EXPECT_GT(a3.sheet_width_mm, a3.sheet_height_mm);  // lying, as upright it would be two
}

TEST(PlanSheets, RefusesABoardInMillimetres) {
  BoardSpec board = SmallChessboard();
  board.width_m = 300;
  EXPECT_THAT(test::ErrorOf([&] { PlanSheets(board, "a4"); }),
              HasSubstr("board of 300 x 0.21 m: larger than 4.9 m cannot be printed"));
}

TEST(BoardSectionLines, AreReadBackAsTheSameBoard) {
  const test::TemporaryFolder folder;
  for (const BoardSpec& board : {SmallChessboard(), SmallCharuco(), SmallAprilGrid()}) {
    std::string text =
        "rig: test\ncamera: {lens_model: plumb_bob, width_px: 640, height_px: 480, fx_px: 500, "
        "fy_px: 500, cx_px: 320, cy_px: 240, distortion: [0, 0, 0, 0, 0]}\n";
    for (const std::string& line : BoardSectionLines(board)) text += line + '\n';
    const BoardSpec read = LoadRig(folder.Write("rig.yaml", text)).board;
    EXPECT_EQ(read.pattern, board.pattern);
    EXPECT_EQ(read.marker_m, board.marker_m);
    EXPECT_EQ(read.InnerCornersBoardM(), board.InnerCornersBoardM());
    EXPECT_EQ(read.OutlineBoardM(), board.OutlineBoardM());
  }
}

}  // namespace
}  // namespace voqcal
