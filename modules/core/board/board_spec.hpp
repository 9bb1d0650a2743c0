#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

enum class BoardPattern { kChessboard, kCharuco };

/// ArUco's predefined dictionaries, in OpenCV's order: "4x4_50", ... "apriltag_36h11".
const std::vector<std::string>& CharucoDictionaries();

/// The calibration board: a flat rectangle with a chessboard on it.
///
/// Board frame: origin at the centre of the rectangle, x along the width, y along the height, z out
/// of the printed face, towards the sensors. Seen from the front with y up, x points right.
struct BoardSpec {
  double width_m = 0.0;   ///< Edge along board x.
  double height_m = 0.0;  ///< Edge along board y.
  double square_m = 0.0;  ///< Side of one chessboard square.
  int num_corners_x = 0;  ///< Inner corners along board x.
  int num_corners_y = 0;  ///< Inner corners along board y.
  /// Centre of the pattern in the board frame, for a board held with y up: where num_corners_x +
  /// num_corners_y is even, nothing in the image tells which way up it is, so that an inverted
  /// board's centre is off by twice this.
  double pattern_offset_x_m = 0.0;
  double pattern_offset_y_m = 0.0;
  BoardPattern pattern = BoardPattern::kChessboard;
  std::string dictionary = "5x5_100";  ///< For kCharuco: one of CharucoDictionaries().
  double marker_m = 0.0;               ///< For kCharuco: side of a marker.

  /// One line for each broken constraint, with its value; empty if the board is usable.
  std::vector<std::string> Problems() const;

  /// The outline's corners, counter-clockwise seen from the front:
  /// (-w/2, -h/2), (w/2, -h/2), (w/2, h/2), (-w/2, h/2). Edge i joins corner i to corner i + 1, so
  /// edges 0 and 2 measure width_m, edges 1 and 3 height_m.
  std::array<Eigen::Vector3d, 4> OutlineBoardM() const;

  /// The true lengths of edges 0..3.
  std::array<double, 4> EdgeLengthsM() const { return {width_m, height_m, width_m, height_m}; }

  /// The chessboard's inner corners, x fastest, from (-x, -y) to (+x, +y).
  std::vector<Eigen::Vector3d> InnerCornersBoardM() const;
};

}  // namespace voqcal
