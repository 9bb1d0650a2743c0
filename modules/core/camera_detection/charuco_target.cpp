#include "core/camera_detection/charuco_target.hpp"

#include "core/camera_detection/charuco_corners.hpp"
#include "core/camera_detection/chessboard_target.hpp"
#include "core/camera_detection/marker_dictionary.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

std::vector<std::string> Problems(const BoardSpec& board) {
  const std::vector<std::string> of_the_grid = board.Problems();
  if (!of_the_grid.empty()) return of_the_grid;
  ProblemList problems;
  const int dictionary = NumberOfDictionary(board.dictionary);
  problems.Require(dictionary >= 0,
                   "dictionary must be a name such as 5x5_100 or apriltag_36h11",
                   board.dictionary);
  problems.Require(board.marker_m > 0 && board.marker_m < board.square_m,
                   "marker_m must be above 0 and below square_m",
                   board.marker_m);
  if (dictionary < 0) return problems.lines();
  const int num_markers = (board.num_corners_x + 1) * (board.num_corners_y + 1) / 2;
  problems.Require(num_markers <= MarkerDictionaries()[dictionary].num_markers,
                   "the dictionary must have a marker for each white square: their number",
                   num_markers);
  return problems.lines();
}

bool HasHalfTurn(const BoardSpec&) { return false; }

// Markers leave a rim.
double Reach(const BoardSpec& board) { return 0.4 * (1 - board.marker_m / board.square_m); }

// The lines of squares, and between them those of the markers' cells: the border's are two more.
std::vector<double> CellLinesM(const std::vector<double>& square_lines_m, const BoardSpec& board) {
  const int num_cells = MarkerDictionaries()[NumberOfDictionary(board.dictionary)].num_cells + 2;
  std::vector<double> lines_m;
  for (std::size_t i = 0; i + 1 < square_lines_m.size(); ++i) {
    lines_m.push_back(square_lines_m[i]);
    const double marker_begin_m = square_lines_m[i] + (board.square_m - board.marker_m) / 2;
    for (int cell = 0; cell <= num_cells; ++cell) {
      lines_m.push_back(marker_begin_m + cell * board.marker_m / num_cells);
    }
  }
  lines_m.push_back(square_lines_m.back());
  return lines_m;
}

PrintedPattern Print(const BoardSpec& board) {
  constexpr int kPixelsPerSquare = 200;  // many to a cell, whose middle is looked at
  const cv::Mat image = DrawCharuco(board, kPixelsPerSquare);
  const auto x_lines_m = CellLinesM(
      SquareLinesM(board.pattern_offset_x_m, board.num_corners_x, board.square_m), board);
  const auto y_lines_m = CellLinesM(
      SquareLinesM(board.pattern_offset_y_m, board.num_corners_y, board.square_m), board);
  const auto middle_px = [&](const std::vector<double>& lines_m, int cell) {
    const double from_begin_m = (lines_m[cell] + lines_m[cell + 1]) / 2 - lines_m.front();
    return static_cast<int>(from_begin_m / board.square_m * kPixelsPerSquare);
  };
  return MakePrintedPattern(x_lines_m, y_lines_m, [&](int i, int j) {
    const int row = image.rows - 1 - middle_px(y_lines_m, j);
    return image.at<unsigned char>(row, middle_px(x_lines_m, i)) < 128;
  });
}

}  // namespace

const CalibrationTarget& Charuco() {
  static const CalibrationTarget kCharuco{
      "charuco", Chessboard().keys, Problems, HasHalfTurn, Reach, FindCharucoCorners, Print};
  return kCharuco;
}

}  // namespace voqcal
