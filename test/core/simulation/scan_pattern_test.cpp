#include "core/simulation/scan_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kDeg = M_PI / 180.0;
constexpr ScanPattern kPatterns[] = {ScanPattern::kVlp16,
                                     ScanPattern::kSpinning64,
                                     ScanPattern::kSpinning128,
                                     ScanPattern::kRaster,
                                     ScanPattern::kRosette};

std::vector<ScanBeam> BeamsOf(ScanPattern pattern, std::int64_t sweep_us = 0) {
  ScanOptions options;
  options.pattern = pattern;
  return BeamsOfSweep(options, sweep_us);
}

double ElevationRad(const ScanBeam& beam) { return std::asin(beam.direction.z()); }

TEST(BeamsOfSweep, HasUnitDirectionsInOrderOfTimeAndKnownEmitters) {
  for (const ScanPattern pattern : kPatterns) {
    float previous_s = 0.0F;
    std::set<int> emitters;
    for (const ScanBeam& beam : BeamsOf(pattern, 1234567)) {
      ASSERT_NEAR(beam.direction.norm(), 1.0, 1e-12) << ToString(pattern);
      ASSERT_GE(beam.time_s, previous_s) << ToString(pattern);
      ASSERT_LT(beam.time_s, 0.1F) << ToString(pattern);
      previous_s = beam.time_s;
      emitters.insert(beam.emitter);
    }
    EXPECT_EQ(static_cast<int>(emitters.size()), NumEmitters(pattern)) << ToString(pattern);
    EXPECT_EQ(*emitters.begin(), 0) << ToString(pattern);
  }
}

TEST(BeamsOfSweep, OfSpinningLidarsTurnsClockwiseFromBehindRingByRing) {
  const std::vector<std::pair<ScanPattern, double>> lidars = {{ScanPattern::kVlp16, 15.0},
                                                              {ScanPattern::kSpinning64, 16.6},
                                                              {ScanPattern::kSpinning128, 22.5}};
  for (const auto& [pattern, max_deg] : lidars) {
    const auto beams = BeamsOf(pattern);
    const int num_rings = NumEmitters(pattern);
    EXPECT_TRUE(HasRings(pattern));
    const auto quarter = beams.size() / 4;
    EXPECT_LT(beams.front().direction.x(), -0.9);
    EXPECT_GT(beams[quarter].direction.y(), 0.9);  // left after a quarter of a turn
    for (const ScanBeam& beam : beams) {
      const double expected_deg = -max_deg + 2 * max_deg * beam.emitter / (num_rings - 1);
      ASSERT_NEAR(ElevationRad(beam), expected_deg * kDeg, 1e-12);
    }
  }
}

TEST(BeamsOfSweep, OfTheRasterIsDenserWhereTold) {
  ScanOptions options;
  options.pattern = ScanPattern::kRaster;
  options.dense_from_rad = 2.0 * kDeg;
  options.dense_to_rad = 7.0 * kDeg;
  const auto beams = BeamsOfSweep(options, 0);
  int num_dense = 0;
  int num_sparse = 0;  // in a band of the same height
  double max_azimuth_rad = 0.0;
  double max_elevation_rad = 0.0;
  for (const ScanBeam& beam : beams) {
    const double elevation_rad = ElevationRad(beam);
    if (elevation_rad > 2.05 * kDeg && elevation_rad < 6.95 * kDeg) ++num_dense;
    if (elevation_rad > -6.95 * kDeg && elevation_rad < -2.05 * kDeg) ++num_sparse;
    max_azimuth_rad =
        std::max(max_azimuth_rad, std::abs(std::atan2(beam.direction.y(), beam.direction.x())));
    max_elevation_rad = std::max(max_elevation_rad, std::abs(elevation_rad));
  }
  // Rows at 0.125 and 0.25 degrees; at the band's ends one row more or less of 20.
  EXPECT_NEAR(static_cast<double>(num_dense) / num_sparse, 2.0, 0.15);
  EXPECT_NEAR(max_azimuth_rad, 55 * kDeg, 1e-9);
  EXPECT_NEAR(max_elevation_rad, 12.5 * kDeg, 0.25 * kDeg);
  EXPECT_FALSE(HasRings(ScanPattern::kRaster));
}

TEST(BeamsOfSweep, OfTheRosetteFillsADiscAndNeverRepeats) {
  const auto first = BeamsOf(ScanPattern::kRosette, 0);
  const auto second = BeamsOf(ScanPattern::kRosette, 100000);
  ASSERT_EQ(first.size(), 24000U);
  ASSERT_EQ(second.size(), first.size());
  EXPECT_FALSE(IsRepeating(ScanPattern::kRosette));
  EXPECT_GT((first[0].direction - second[0].direction).norm(), 0.01);
  double max_bend_rad = 0.0;
  std::set<std::pair<int, int>> cells;  // of 5 degrees
  for (const ScanBeam& beam : first) {
    max_bend_rad = std::max(max_bend_rad, std::acos(beam.direction.x()));
    const double left_deg = std::atan2(beam.direction.y(), beam.direction.x()) / kDeg;
    const double up_deg = ElevationRad(beam) / kDeg;
    if (std::hypot(left_deg, up_deg) > 30) continue;
    cells.emplace(static_cast<int>(std::floor(left_deg / 5)),
                  static_cast<int>(std::floor(up_deg / 5)));
  }
  // 35.2 degrees, and 2.25 more for the outermost emitters.
  EXPECT_LE(max_bend_rad, (35.2 + 2.25) * kDeg + 1e-9);
  EXPECT_GT(max_bend_rad, 35.2 * kDeg);
  EXPECT_GT(cells.size(), 105U);  // pi * 6^2 = 113 cells in the disc, and those on its rim
}

TEST(IsInFieldOfView, AgreesWithTheBeams) {
  for (const ScanPattern pattern : kPatterns) {
    if (pattern == ScanPattern::kRosette) continue;  // its emitters reach beyond the common disc
    for (const ScanBeam& beam : BeamsOf(pattern)) {
      ASSERT_TRUE(IsInFieldOfView(pattern, 3.0 * beam.direction, -1e-9)) << ToString(pattern);
    }
  }
}

TEST(IsInFieldOfView, KeepsTheMargin) {
  const auto at = [](double azimuth_deg, double elevation_deg) {
    return Eigen::Vector3d(std::cos(elevation_deg * kDeg) * std::cos(azimuth_deg * kDeg),
                           std::cos(elevation_deg * kDeg) * std::sin(azimuth_deg * kDeg),
                           std::sin(elevation_deg * kDeg));
  };
  EXPECT_TRUE(IsInFieldOfView(ScanPattern::kVlp16, at(170, -14.7), 0.25 * kDeg));
  EXPECT_FALSE(IsInFieldOfView(ScanPattern::kVlp16, at(170, -14.8), 0.25 * kDeg));
  EXPECT_TRUE(IsInFieldOfView(ScanPattern::kRaster, at(-53.9, 11.4), kDeg));
  EXPECT_FALSE(IsInFieldOfView(ScanPattern::kRaster, at(-54.1, 11.4), kDeg));
  EXPECT_FALSE(IsInFieldOfView(ScanPattern::kRaster, at(-53.9, 11.6), kDeg));
  EXPECT_TRUE(IsInFieldOfView(ScanPattern::kRosette, at(34.1, 0.0), kDeg));
  EXPECT_FALSE(IsInFieldOfView(ScanPattern::kRosette, at(0.0, 34.3), kDeg));
  EXPECT_FALSE(IsInFieldOfView(ScanPattern::kRosette, at(180.0, 0.0), 0.0));
}

TEST(ScanPatternFromString, ReadsWhatToStringWrites) {
  for (const ScanPattern pattern : kPatterns) {
    EXPECT_EQ(ScanPatternFromString(ToString(pattern)), pattern);
  }
  EXPECT_EQ(ScanPatternFromString("spiral"), std::nullopt);
}

TEST(ScanOptionsProblems, NamesTheRuleAndTheValues) {
  ScanOptions options;
  EXPECT_THAT(options.Problems(), IsEmpty());
  options.dense_from_rad = 5 * kDeg;
  EXPECT_THAT(options.Problems(), ElementsAre(HasSubstr("at most dense_to_deg, is 5 and 4")));
}

}  // namespace
}  // namespace voqcal
