#include "core/board/board_spec.hpp"

#include <algorithm>
#include <cmath>

#include "core/problems.hpp"

namespace voqcal {
std::vector<std::string> BoardSpec::Problems() const {
  ProblemList problems;
  problems.RequirePositive("width_m", width_m);
  problems.RequirePositive("height_m", height_m);
  problems.RequirePositive("square_m", square_m);
  problems.Require(num_corners_x >= 3, "num_corners_x must be at least 3", num_corners_x);
  problems.Require(num_corners_y >= 3, "num_corners_y must be at least 3", num_corners_y);
  if (!problems.empty()) return problems.lines();
  // The pattern has one square more than inner corners on each axis; a partial square may be
  // missing.
  const double span_x_m = SquaresTo(num_corners_x - 1) * square_m;
  const double span_y_m = SquaresTo(num_corners_y - 1) * square_m;
  problems.Require(span_x_m < width_m,
                   "the pattern's corners along x must span less than width_m (both are in metres)",
                   span_x_m);
  problems.Require(
      span_y_m < height_m,
      "the pattern's corners along y must span less than height_m (both are in metres)",
      span_y_m);
  return problems.lines();
}

std::array<Eigen::Vector3d, 4> BoardSpec::OutlineBoardM() const {
  const double x = width_m / 2;
  const double y = height_m / 2;
  return {Eigen::Vector3d(-x, -y, 0),
          Eigen::Vector3d(x, -y, 0),
          Eigen::Vector3d(x, y, 0),
          Eigen::Vector3d(-x, y, 0)};
}

std::vector<Eigen::Vector3d> BoardSpec::InnerCornersBoardM() const {
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(static_cast<std::size_t>(num_corners_x) * num_corners_y);
  for (int j = 0; j < num_corners_y; ++j) {
    for (int i = 0; i < num_corners_x; ++i) {
      corners.emplace_back(
          pattern_offset_x_m + (SquaresTo(i) - SquaresTo(num_corners_x - 1) / 2.0) * square_m,
          pattern_offset_y_m + (SquaresTo(j) - SquaresTo(num_corners_y - 1) / 2.0) * square_m,
          0.0);
    }
  }
  return corners;
}

}  // namespace voqcal
