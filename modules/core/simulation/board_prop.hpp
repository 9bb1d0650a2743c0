#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/board/printed_pattern.hpp"
#include "core/simulation/props.hpp"

namespace voqcal {

/// The board's printed face in rectangular cells, each of one shade. Cells around what is printed
/// are its white margin; beyond the outline there is nothing.
class BoardFace {
 public:
  explicit BoardFace(const BoardSpec& board);

  /// Number of the cell at a point of the board plane. Cells are convex: what lies between points
  /// of the same cell is in that cell.
  int CellAt(double x_board_m, double y_board_m) const;

  bool IsOutside(int cell) const;  ///< Beyond the outline.
  bool IsDark(int cell) const;

  static constexpr float kDarkAlbedo = 0.08F;
  static constexpr float kBrightAlbedo = 0.80F;

 private:
  int NumAlongX() const;  ///< Cells of a row, margin and outside included.

  PrintedPattern printed_;
  double half_width_m_;
  double half_height_m_;
};

constexpr float kTubeAlbedo = 0.12F;  ///< Dull black metal.

/// The stand: a boom from the board's back, a pole that carries it and three feet on the floor.
/// It stays behind the board's plane, so it hides nothing of the face.
std::array<Tube, 5> StandTubes(const Eigen::Isometry3d& T_lidar_board,
                               const BoardSpec& board,
                               double floor_z_m);

/// Points along the outline, `num_per_edge` to an edge, corners included.
std::vector<Eigen::Vector3d> OutlinePointsBoardM(const BoardSpec& board, int num_per_edge);

}  // namespace voqcal
