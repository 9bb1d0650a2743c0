#include "core/lidar/scan_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

/// Sixteen lines, two degrees apart, at ranges of a few metres, in shuffled order.
PointCloud SixteenLines() {
  constexpr double kDeg = 3.14159265358979323846 / 180.0;
  PointCloud cloud;
  cloud.has_ring = true;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> range_m(1.0, 9.0);
  for (int column = 0; column < 300; ++column) {
    for (int line = 0; line < 16; ++line) {
      const double elevation = (2.0 * line - 15.0) * kDeg;
      const double azimuth = 1.2 * column * kDeg;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth),
                                      std::sin(elevation));
      LidarPoint point;
      point.position_m = (range_m(random) * direction).cast<float>();
      point.ring = static_cast<std::uint16_t>(line);
      cloud.points.push_back(point);
    }
  }
  std::shuffle(cloud.points.begin(), cloud.points.end(), random);
  return cloud;
}

void Expect(const PointCloud& cloud) {
  const std::vector<std::uint16_t> lines = ScanLinesOf(cloud);
  ASSERT_EQ(lines.size(), cloud.points.size());
  for (std::size_t i = 0; i < lines.size(); ++i) ASSERT_EQ(lines[i], cloud.points[i].ring);
}

TEST(ScanLinesOf, TellsTheLinesOfASpinningLidar) { Expect(SixteenLines()); }

TEST(ScanLinesOf, AnyAxisOfTheFrameMayBeTheLidars) {
  PointCloud cloud = SixteenLines();
  for (LidarPoint& point : cloud.points) {
    const Eigen::Vector3f p_m = point.position_m;
    point.position_m = {p_m.z(), p_m.x(), p_m.y()};
  }
  Expect(cloud);
}

TEST(ScanLinesOf, ThereAreNoneInAScanWithoutLines) {
  PointCloud cloud = SixteenLines();
  std::mt19937 random(2);
  std::normal_distribution<float> off(0.0F, 0.3F);
  for (LidarPoint& point : cloud.points) point.position_m.z() += off(random);
  EXPECT_TRUE(ScanLinesOf(cloud).empty());
}

TEST(AreRingsScanLines, NotIfTheyAreConstantOrCountSomethingElse) {
  PointCloud cloud = SixteenLines();
  EXPECT_TRUE(AreRingsScanLines(cloud));
  PointCloud constant = cloud;
  for (LidarPoint& point : constant.points) point.ring = 3;
  EXPECT_FALSE(AreRingsScanLines(constant));
  PointCloud counted = cloud;
  for (std::size_t i = 0; i < counted.points.size(); ++i) {
    counted.points[i].ring = static_cast<std::uint16_t>(i % 16);
  }
  EXPECT_FALSE(AreRingsScanLines(counted));
}

}  // namespace
}  // namespace voqcal
