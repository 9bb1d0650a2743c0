#include "core/camera_detection/marker_dictionary.hpp"

namespace voqcal {

const std::vector<MarkerDictionary>& MarkerDictionaries() {
  static const std::vector<MarkerDictionary> kDictionaries = {
      {"4x4_50", 50, 4},        {"4x4_100", 100, 4},         {"4x4_250", 250, 4},
      {"4x4_1000", 1000, 4},    {"5x5_50", 50, 5},           {"5x5_100", 100, 5},
      {"5x5_250", 250, 5},      {"5x5_1000", 1000, 5},       {"6x6_50", 50, 6},
      {"6x6_100", 100, 6},      {"6x6_250", 250, 6},         {"6x6_1000", 1000, 6},
      {"7x7_50", 50, 7},        {"7x7_100", 100, 7},         {"7x7_250", 250, 7},
      {"7x7_1000", 1000, 7},    {"aruco_original", 1024, 5}, {"apriltag_16h5", 30, 4},
      {"apriltag_25h9", 35, 5}, {"apriltag_36h10", 2320, 6}, {"apriltag_36h11", 587, 6}};
  return kDictionaries;
}

int NumberOfDictionary(const std::string& name) {
  const auto& all = MarkerDictionaries();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace voqcal
