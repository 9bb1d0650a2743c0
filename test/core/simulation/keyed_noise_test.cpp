#include "core/simulation/keyed_noise.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

constexpr int kNumDraws = 100000;

TEST(MixBits, IsSplitmix64) {
  // The first numbers of the published generator from state 0.
  EXPECT_EQ(MixBits(0x9e3779b97f4a7c15ULL), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(MixBits(2 * 0x9e3779b97f4a7c15ULL), 0x6e789e6aa1b965f4ULL);
}

TEST(KeyedNoise, UniformIsEven) {
  const KeyedNoise noise(7, NoiseUse::kRange, 1000);
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (int i = 0; i < kNumDraws; ++i) {
    const double value = noise.Uniform(i);
    ASSERT_GT(value, 0.0);
    ASSERT_LT(value, 1.0);
    sum += value;
    sum_of_squares += value * value;
  }
  // Standard errors: sqrt(1 / 12 / n) = 0.0009 and sqrt(4 / 45 / n) = 0.0009; allow 4 of them.
  EXPECT_NEAR(sum / kNumDraws, 0.5, 0.004);
  EXPECT_NEAR(sum_of_squares / kNumDraws, 1.0 / 3.0, 0.004);
}

TEST(KeyedNoise, NormalsAreStandardAndIndependent) {
  const KeyedNoise noise(7, NoiseUse::kRange, 1000);
  double mean = 0.0;
  double variance = 0.0;
  double fourth = 0.0;
  double product = 0.0;
  for (int i = 0; i < kNumDraws; ++i) {
    const auto [a, b] = noise.Normals(i);
    mean += (a + b) / (2 * kNumDraws);
    variance += (a * a + b * b) / (2 * kNumDraws);
    fourth += (a * a * a * a + b * b * b * b) / (2 * kNumDraws);
    product += a * b / kNumDraws;
  }
  // Four standard errors of 2n (product: n) draws: 1, sqrt(2), sqrt(96) and 1 over the root.
  EXPECT_NEAR(mean, 0.0, 4 / std::sqrt(2.0 * kNumDraws));
  EXPECT_NEAR(variance, 1.0, 4 * std::sqrt(2 / (2.0 * kNumDraws)));
  EXPECT_NEAR(fourth, 3.0, 4 * std::sqrt(96 / (2.0 * kNumDraws)));
  EXPECT_NEAR(product, 0.0, 4 / std::sqrt(1.0 * kNumDraws));
}

TEST(KeyedNoise, EveryPartOfTheKeyCounts) {
  std::set<std::uint64_t> seen;
  for (std::uint32_t seed : {0U, 1U, 2U}) {
    for (NoiseUse use : {NoiseUse::kRange, NoiseUse::kDropout}) {
      for (std::int64_t frame_us : {0, 1, 100000}) {
        for (std::uint64_t index : {0, 1, 2}) {
          seen.insert(KeyedNoise(seed, use, frame_us).Bits(index));
        }
      }
    }
  }
  EXPECT_EQ(seen.size(), 3U * 2U * 3U * 3U);
}

}  // namespace
}  // namespace voqcal
