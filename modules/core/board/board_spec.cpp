#include "core/board/board_spec.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "core/problems.hpp"

namespace voqcal {
namespace {

// Of a dictionary: the number that its name ends in, but for ArUco's own and AprilTag's (OpenCV's
// dictionary.hpp).
int NumMarkers(const std::string& dictionary) {
  static const std::map<std::string, int> kOthers = {{"aruco_original", 1024},
                                                     {"apriltag_16h5", 30},
                                                     {"apriltag_25h9", 35},
                                                     {"apriltag_36h10", 2320},
                                                     {"apriltag_36h11", 587}};
  const auto other = kOthers.find(dictionary);
  if (other != kOthers.end()) return other->second;
  return std::atoi(dictionary.c_str() + dictionary.find('_') + 1);
}

}  // namespace

const std::vector<std::string>& CharucoDictionaries() {
  static const std::vector<std::string> kNames = {
      "4x4_50",        "4x4_100",        "4x4_250",       "4x4_1000",      "5x5_50",
      "5x5_100",       "5x5_250",        "5x5_1000",      "6x6_50",        "6x6_100",
      "6x6_250",       "6x6_1000",       "7x7_50",        "7x7_100",       "7x7_250",
      "7x7_1000",      "aruco_original", "apriltag_16h5", "apriltag_25h9", "apriltag_36h10",
      "apriltag_36h11"};
  return kNames;
}

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
  problems.Require(
      (num_corners_x - 1) * square_m < width_m,
      "the inner corners along x must fit into width_m: (num_corners_x - 1) * square_m",
      (num_corners_x - 1) * square_m);
  problems.Require(
      (num_corners_y - 1) * square_m < height_m,
      "the inner corners along y must fit into height_m: (num_corners_y - 1) * square_m",
      (num_corners_y - 1) * square_m);
  if (pattern != BoardPattern::kCharuco) return problems.lines();
  const auto& names = CharucoDictionaries();
  problems.Require(std::find(names.begin(), names.end(), dictionary) != names.end(),
                   "dictionary must be a name such as 5x5_100 or apriltag_36h11",
                   dictionary);
  problems.Require(
      marker_m > 0 && marker_m < square_m, "marker_m must be above 0 and below square_m", marker_m);
  problems.Require((num_corners_x + 1) * (num_corners_y + 1) / 2 <= NumMarkers(dictionary),
                   "the dictionary must have a marker for each white square: their number",
                   (num_corners_x + 1) * (num_corners_y + 1) / 2);
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
      corners.emplace_back(pattern_offset_x_m + (i - (num_corners_x - 1) / 2.0) * square_m,
                           pattern_offset_y_m + (j - (num_corners_y - 1) / 2.0) * square_m,
                           0.0);
    }
  }
  return corners;
}

}  // namespace voqcal
