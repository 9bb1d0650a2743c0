#include "core/camera/lens_distortion.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal::detail {
namespace {

// By steps along the radius: does the distorted radius grow, and has the denominator no zero?
bool GrowsUpTo(const Distortion& lens, double radius) {
  constexpr int kNumSteps = 2000;
  double before = 0;
  for (int i = 1; i <= kNumSteps; ++i) {
    const double r = radius * i / kNumSteps;
    const double denominator = Polynomial(lens.denominator, r * r);
    const double distorted = r * Polynomial(lens.numerator, r * r) / denominator;
    if (denominator <= 0 || distorted <= before) return false;
    before = distorted;
  }
  return true;
}

// Lenses of every kind, from hardly distorted to absurd: what the coefficients' sizes settle and
// what the polynomials must be asked for.
TEST(IsOnGrowingBranch, IsWhereTheDistortedRadiusGrows) {
  test::Random random(11);
  int num_growing = 0;
  constexpr int kNumLenses = 3000;
  for (int run = 0; run < kNumLenses; ++run) {
    const double size = std::pow(10.0, random.Uniform(-2.0, 1.5));
    Distortion lens;
    for (std::size_t i = 1; i < lens.numerator.size(); ++i) {
      lens.numerator[i] = size * random.Uniform(-1, 1);
    }
    for (std::size_t i = 1; run % 2 == 0 && i < lens.denominator.size(); ++i) {
      lens.denominator[i] = size * random.Uniform(-1, 1);
    }
    const double radius = random.Uniform(0.1, 1.4);
    const bool grows = GrowsUpTo(lens, radius);
    // At the very turn steps cannot tell.
    if (grows != GrowsUpTo(lens, 1.01 * radius)) continue;
    EXPECT_EQ(IsOnGrowingBranch(lens, HUGE_VAL, {0.6 * radius, 0.8 * radius}), grows)
        << "lens " << run << ", radius " << radius;
    num_growing += grows ? 1 : 0;
  }
  EXPECT_GT(num_growing, kNumLenses / 4);
  EXPECT_LT(num_growing, 3 * kNumLenses / 4);
}

}  // namespace
}  // namespace voqcal::detail
