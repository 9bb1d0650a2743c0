#include "core/camera_detection/chessboard_target.hpp"

#include "core/camera_detection/chessboard_corners.hpp"

namespace voqcal {
namespace {

std::vector<std::string> Problems(const BoardSpec& board) { return board.Problems(); }

bool HasHalfTurn(const BoardSpec& board) {
  return (board.num_corners_x + board.num_corners_y) % 2 == 0;
}

double Reach(const BoardSpec&) { return 0.4; }

Expected<std::vector<Eigen::Vector2d>, CameraBoardMiss> FindCorners(const cv::Mat& grey,
                                                                    const BoardSpec& board) {
  const auto corners_px = FindChessboardCorners(grey, board);
  if (!corners_px) return ExplainPart(grey, board, corners_px.error());
  return *corners_px;
}

PrintedPattern Print(const BoardSpec& board) {
  return MakePrintedPattern(
      SquareLinesM(board.pattern_offset_x_m, board.num_corners_x, board.square_m),
      SquareLinesM(board.pattern_offset_y_m, board.num_corners_y, board.square_m),
      [](int i, int j) { return (i + j) % 2 == 0; });
}

}  // namespace

const CalibrationTarget& Chessboard() {
  static const CalibrationTarget kChessboard{
      "chessboard",
      {{"square_m", &BoardSpec::square_m, "side of one square: measure several at once"},
       {"num_corners_x",
        &BoardSpec::num_corners_x,
        "inner corners along the width: one less than squares"},
       {"num_corners_y", &BoardSpec::num_corners_y, "inner corners along the height"},
       // ChArUco's, without effect: a rig file may keep them.
       {"dictionary",
        &BoardSpec::dictionary,
        "of charuco: 4x4_50 to 7x7_1000, apriltag_36h11, ...",
        false},
       {"marker_m", &BoardSpec::marker_m, "of charuco: side of a marker", false}},
      Problems,
      HasHalfTurn,
      Reach,
      FindCorners,
      Print};
  return kChessboard;
}

std::vector<double> SquareLinesM(double offset_m, int num_corners, double square_m) {
  std::vector<double> lines_m;
  const double begin_m = offset_m - (num_corners + 1) * square_m / 2;
  for (int i = 0; i < num_corners + 2; ++i) lines_m.push_back(begin_m + i * square_m);
  return lines_m;
}

}  // namespace voqcal
