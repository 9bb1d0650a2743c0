#include "core/lidar_detection/board_bend.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

constexpr double kWidthM = 0.6;
constexpr double kHeightM = 0.8;

struct Points {
  std::vector<Eigen::Vector3d> points_m;
  std::vector<std::uint16_t> rings;
};

/// Twelve scan lines of forty points on z = bend_m * (2 x / width)^2, each line off by `ring_m`.
Points BentBoard(double bend_m, double noise_m, double ring_m, std::uint32_t seed) {
  std::mt19937 random(seed);
  Points board;
  for (std::uint16_t ring = 0; ring < 12; ++ring) {
    const double offset_m = ring_m * test::UnitGaussian(&random);
    for (int i = 0; i < 40; ++i) {
      const double u = (i + 0.5) / 20 - 1.0;
      const double v = (ring + 0.5) / 6 - 1.0;
      board.points_m.emplace_back(
          u * kWidthM / 2,
          v * kHeightM / 2,
          bend_m * u * u + offset_m + noise_m * test::UnitGaussian(&random));
      board.rings.push_back(ring);
    }
  }
  return board;
}

TEST(MeasureBend, IsExactWithoutNoise) {
  const Points board = BentBoard(0.03, 0.0, 0.0, 1);
  const BoardBend bend = MeasureBend(board.points_m, board.rings, kWidthM, kHeightM);
  // From the middle (0) to the sides (30 mm), less what the weak pull to flat takes of 480 points.
  EXPECT_NEAR(bend.bend_m, 0.03, 1e-6);
  EXPECT_LT(bend.sigma_m, 1e-6);
}

TEST(MeasureBend, TiltAndShiftAreNoBend) {
  Points board = BentBoard(0.0, 0.0, 0.0, 1);
  for (Eigen::Vector3d& p_m : board.points_m) p_m.z() = 0.1 + 0.3 * p_m.x() - 0.2 * p_m.y();
  EXPECT_LT(MeasureBend(board.points_m, board.rings, kWidthM, kHeightM).bend_m, 1e-6);
}

TEST(MeasureBend, ErrorCoversNoiseAndOffsetsOfScanLines) {
  // Bends across the lines, which their offsets cannot feign, and within 3 standard errors nearly
  // always: of 200 draws of a normal 0.5 are farther out, with a dozen lines a few more.
  constexpr int kNumTrials = 200;
  int num_outside = 0;
  for (std::uint32_t seed = 1; seed <= kNumTrials; ++seed) {
    const Points board = BentBoard(0.04, 0.01, 0.008, seed);
    const BoardBend bend = MeasureBend(board.points_m, board.rings, kWidthM, kHeightM);
    num_outside += bend.bend_m - 3 * bend.sigma_m > 0.04;
  }
  EXPECT_LE(num_outside, kNumTrials / 20);
}

TEST(MeasureBend, FewScanLinesProveNothing) {
  Points board = BentBoard(0.04, 0.01, 0.0, 1);
  for (std::uint16_t& ring : board.rings) ring = static_cast<std::uint16_t>(ring / 2);
  const BoardBend bend = MeasureBend(board.points_m, board.rings, kWidthM, kHeightM);
  EXPECT_GT(bend.sigma_m, 1.0);
}

}  // namespace
}  // namespace voqcal
