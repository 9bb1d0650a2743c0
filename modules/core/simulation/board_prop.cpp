#include "core/simulation/board_prop.hpp"

#include <algorithm>
#include <cmath>

namespace voqcal {
namespace {

// Cells are numbered row by row; a row has two more on each side than there are squares: the margin
// and the outside.
constexpr int kSides = 2;

int CellAlong(double from_begin_m, double square_m, int num_squares, bool is_below, bool is_above) {
  if (is_below) return 0;
  if (is_above) return num_squares + 2 * kSides - 1;
  const auto square = static_cast<int>(std::floor(from_begin_m / square_m));
  return kSides + std::clamp(square, -1, num_squares);
}

}  // namespace

BoardFace::BoardFace(const BoardSpec& board)
    : num_x_(board.num_corners_x + 1),
      num_y_(board.num_corners_y + 1),
      square_m_(board.square_m),
      left_m_(board.pattern_offset_x_m - num_x_ * board.square_m / 2),
      bottom_m_(board.pattern_offset_y_m - num_y_ * board.square_m / 2),
      half_width_m_(board.width_m / 2),
      half_height_m_(board.height_m / 2) {}

int BoardFace::CellAt(double x_board_m, double y_board_m) const {
  const bool is_left = x_board_m < -half_width_m_;
  const bool is_right = x_board_m > half_width_m_;
  const bool is_below = y_board_m < -half_height_m_;
  const bool is_above = y_board_m > half_height_m_;
  const int i = CellAlong(x_board_m - left_m_, square_m_, num_x_, is_left, is_right);
  const int j = CellAlong(y_board_m - bottom_m_, square_m_, num_y_, is_below, is_above);
  return j * (num_x_ + 2 * kSides) + i;
}

bool BoardFace::IsOutside(int cell) const {
  const int i = cell % (num_x_ + 2 * kSides);
  const int j = cell / (num_x_ + 2 * kSides);
  return i == 0 || j == 0 || i == num_x_ + 2 * kSides - 1 || j == num_y_ + 2 * kSides - 1;
}

bool BoardFace::IsDark(int cell) const {
  const int i = cell % (num_x_ + 2 * kSides) - kSides;
  const int j = cell / (num_x_ + 2 * kSides) - kSides;
  return i >= 0 && j >= 0 && i < num_x_ && j < num_y_ && (i + j) % 2 == 0;
}

std::array<Tube, 5> StandTubes(const Eigen::Isometry3d& T_lidar_board,
                               const BoardSpec& board,
                               double floor_z_m) {
  constexpr double kBoomStartM = 0.02;      // behind the face
  constexpr double kPoleClearanceM = 0.07;  // of the pole from the board's plane
  constexpr double kHubHeightM = 0.18;
  constexpr double kFootLengthM = 0.30;
  const Eigen::Vector3d normal = T_lidar_board.linear().col(2);
  const double half_diagonal_m = std::hypot(board.width_m, board.height_m) / 2;
  const double level = std::max(normal.head<2>().norm(), 0.1);
  const Eigen::Vector3d away = -Eigen::Vector3d(normal.x(), normal.y(), 0.0) / level;
  // A board that leans forwards (normal.z < 0) brings its lower part back towards the pole: at
  // depth h below its centre the plane is h * |normal.z| / level behind it; h <= half_diagonal *
  // level.
  const double boom_m = kPoleClearanceM / level + half_diagonal_m * std::max(0.0, -normal.z());
  const Eigen::Vector3d centre_m = T_lidar_board.translation();
  const Eigen::Vector3d pole_top_m = centre_m + boom_m * away;
  const Eigen::Vector3d pole_foot_m(pole_top_m.x(), pole_top_m.y(), floor_z_m + 0.05);
  const Eigen::Vector3d hub_m(pole_top_m.x(), pole_top_m.y(), floor_z_m + kHubHeightM);
  std::array<Tube, 5> tubes{Tube{centre_m - kBoomStartM * normal, pole_top_m, 0.015},
                            Tube{pole_foot_m, pole_top_m, 0.02}};
  for (int foot = 0; foot < 3; ++foot) {
    const Eigen::AngleAxisd turn(foot * 2.0 * M_PI / 3.0, Eigen::Vector3d::UnitZ());
    Eigen::Vector3d tip_m = hub_m + kFootLengthM * (turn * away);
    tip_m.z() = floor_z_m + 0.012;
    tubes[2 + foot] = Tube{hub_m, tip_m, 0.012};
  }
  return tubes;
}

std::vector<Eigen::Vector3d> OutlinePointsBoardM(const BoardSpec& board, int num_per_edge) {
  const std::array<Eigen::Vector3d, 4> corners = board.OutlineBoardM();
  std::vector<Eigen::Vector3d> points;
  for (int edge = 0; edge < 4; ++edge) {
    for (int i = 0; i < num_per_edge; ++i) {
      const double t = static_cast<double>(i) / num_per_edge;
      points.push_back((1 - t) * corners[edge] + t * corners[(edge + 1) % 4]);
    }
  }
  return points;
}

}  // namespace voqcal
