#include "core/lidar/shade_scale.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

TEST(ShadeScale, DarkIsHalfAndBrightIsMinusHalf) {
  const ShadeScale scale = ShadeScaleOf({1, 2, 1, 2, 1, 60, 64, 60, 64, 62});
  EXPECT_NEAR(scale.ShadeOf(1.0F), 0.5, 0.02);
  EXPECT_EQ(scale.ShadeOf(60.0F), -0.5);
}

TEST(ShadeScale, TellsNothingWithoutContrast) {
  EXPECT_EQ(ShadeScaleOf({}).ShadeOf(10.0F), 0.0);
  EXPECT_EQ(ShadeScaleOf({7, 7, 7}).ShadeOf(7.0F), 0.0);
}

TEST(ShadeScale, LeavesOutIntensitiesThatAreNotNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const ShadeScale scale = ShadeScaleOf({1, nan, 1, 60, nan, 60, 1, 60});
  EXPECT_EQ(scale.ShadeOf(nan), 0.0);
  EXPECT_NEAR(scale.ShadeOf(1.0F), 0.5, 0.02);
  EXPECT_EQ(scale.ShadeOf(60.0F), -0.5);
}

TEST(DarkStepM, IsTheDifferenceOfDarkAndBright) {
  std::vector<double> residuals_m;
  std::vector<double> shades;
  for (int i = 0; i < 400; ++i) {
    shades.push_back(i % 2 == 0 ? 0.5 : -0.5);
    residuals_m.push_back(0.003 + 0.015 * shades.back());
  }
  // What is expected pulls by (10 mm / 20 mm)^2 of the information of 400 / 4 = 100.
  EXPECT_NEAR(DarkStepM(residuals_m, shades), 0.015, 0.015 * 0.25 / 100 + 1e-9);
}

TEST(DarkStepM, IsZeroWhereShadesDoNotDiffer) {
  EXPECT_EQ(DarkStepM({0.01, -0.02}, {0.5, 0.5}), 0.0);
  EXPECT_EQ(DarkStepM({}, {}), 0.0);
}

}  // namespace
}  // namespace voqcal
