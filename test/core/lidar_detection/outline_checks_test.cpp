#include "core/lidar_detection/outline_checks.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

TEST(Compare, TellsFieldsThatNoBeamMeetsFromEmptyOnes) {
  OutlineModel model;
  model.width_m = 0.6;
  model.height_m = 0.8;
  std::vector<OutlineBeam> unseen;  // beams 2 cm apart, but for the four fields in the middle
  std::vector<OutlineBeam> empty;
  for (double x_m = -0.29; x_m < 0.3; x_m += 0.02) {
    for (double y_m = -0.39; y_m < 0.4; y_m += 0.02) {
      const bool is_middle = std::abs(x_m) < 0.15 && std::abs(y_m) < 0.2;
      if (!is_middle) unseen.push_back({{x_m, y_m}, true});
      empty.push_back({{x_m, y_m}, !is_middle});
    }
  }
  EXPECT_EQ(Compare(unseen, {}, model, {}).empty, 0.0);
  EXPECT_EQ(Compare(empty, {}, model, {}).empty, 0.25);
  EXPECT_EQ(Compare(empty, {}, model, {}).covered, 0.75);
}

}  // namespace
}  // namespace voqcal
