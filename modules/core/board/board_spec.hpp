#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// The calibration board: a flat rectangle with a pattern on it, whose corners lie on a grid.
///
/// Board frame: origin at the centre of the rectangle, x along the width, y along the height, z out
/// of the printed face, towards the sensors. Seen from the front with y up, x points right.
struct BoardSpec {
  double width_m = 0.0;   ///< Edge along board x.
  double height_m = 0.0;  ///< Edge along board y.
  double square_m = 0.0;  ///< Side of one chessboard square, or of one tag.
  int num_corners_x = 0;  ///< Corners of the pattern along board x.
  int num_corners_y = 0;  ///< Corners of the pattern along board y.
  /// Centre of the pattern in the board frame, for a board held with y up: where the pattern looks
  /// the same after half a turn, an inverted board's centre is off by twice this.
  double pattern_offset_x_m = 0.0;
  double pattern_offset_y_m = 0.0;
  /// What is printed on it: a name of core/camera_detection/calibration_target.hpp, whose rows say
  /// which of the fields below they use.
  std::string pattern = "chessboard";
  std::string dictionary = "5x5_100";  ///< Of markers.
  double marker_m = 0.0;               ///< Side of a marker within a square.
  /// Corners come in pairs one square apart; from pair to pair it is this share of a square.
  double gap_squares = 1.0;

  /// One line for each broken constraint that holds of every pattern, with its value.
  std::vector<std::string> Problems() const;

  /// The outline's corners, counter-clockwise seen from the front:
  /// (-w/2, -h/2), (w/2, -h/2), (w/2, h/2), (-w/2, h/2). Edge i joins corner i to corner i + 1, so
  /// edges 0 and 2 measure width_m, edges 1 and 3 height_m.
  std::array<Eigen::Vector3d, 4> OutlineBoardM() const;

  /// The true lengths of edges 0..3.
  std::array<double, 4> EdgeLengthsM() const { return {width_m, height_m, width_m, height_m}; }

  /// How far corner i of a row or column lies from corner 0, in squares.
  double SquaresTo(int i) const { return (i + 1) / 2 + gap_squares * (i / 2); }

  /// Width and height of the least plate that the pattern fits on: one that is cut closer than half
  /// a square round its corners has no whole square left there.
  Eigen::Vector2d LeastPlateM() const {
    return square_m *
           Eigen::Vector2d(SquaresTo(num_corners_x - 1) + 1, SquaresTo(num_corners_y - 1) + 1);
  }

  /// The pattern's corners, x fastest, from (-x, -y) to (+x, +y).
  std::vector<Eigen::Vector3d> InnerCornersBoardM() const;
};

}  // namespace voqcal
