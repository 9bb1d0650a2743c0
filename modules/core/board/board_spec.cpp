#include "core/board/board_spec.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace voqcal {
namespace {

template <typename Value>
std::string Problem(const char* rule, Value value) {
  std::ostringstream text;
  text << rule << ", is " << value;
  return text.str();
}

}  // namespace

std::vector<std::string> BoardSpec::Problems() const {
  std::vector<std::string> problems;
  const auto require = [&problems](bool is_met, const char* rule, auto value) {
    if (!is_met) problems.push_back(Problem(rule, value));
  };
  require(width_m > 0, "width_m must be positive", width_m);
  require(height_m > 0, "height_m must be positive", height_m);
  require(square_m > 0, "square_m must be positive", square_m);
  require(num_corners_x >= 3, "num_corners_x must be at least 3", num_corners_x);
  require(num_corners_y >= 3, "num_corners_y must be at least 3", num_corners_y);
  if (!problems.empty()) return problems;
  // Both detectors tell half-turns apart at most: a square's quarter-turns would go unnoticed.
  require(std::abs(width_m - height_m) >= 0.05 * std::max(width_m, height_m),
          "width_m and height_m must differ by at least 5 %: width_m",
          width_m);
  // The pattern has one square more than inner corners on each axis; a partial square may be
  // missing.
  require((num_corners_x - 1) * square_m < width_m,
          "the inner corners along x must fit into width_m: (num_corners_x - 1) * square_m",
          (num_corners_x - 1) * square_m);
  require((num_corners_y - 1) * square_m < height_m,
          "the inner corners along y must fit into height_m: (num_corners_y - 1) * square_m",
          (num_corners_y - 1) * square_m);
  return problems;
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
      corners.emplace_back(pattern_offset_x_m + (i - (num_corners_x - 1) / 2.0) * square_m,
                           pattern_offset_y_m + (j - (num_corners_y - 1) / 2.0) * square_m,
                           0.0);
    }
  }
  return corners;
}

}  // namespace voqcal
