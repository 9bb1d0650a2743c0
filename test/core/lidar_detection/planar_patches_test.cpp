#include "core/lidar_detection/planar_patches.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/lidar_detection/lidar_beams.hpp"
#include "core/lidar_detection/lidar_board.hpp"

namespace voqcal {
namespace {

double Uniform(std::mt19937* random, double low, double high) {
  return low + (high - low) * static_cast<double>((*random)()) / 4294967296.0;
}

/// Of 0.6 x 0.84 m, 2 m ahead.
std::vector<Eigen::Vector3d> Rectangle(std::mt19937* random) {
  std::vector<Eigen::Vector3d> points_m;
  for (int i = 0; i < 800; ++i) {
    points_m.emplace_back(2.0, Uniform(random, -0.3, 0.3), Uniform(random, -0.42, 0.42));
  }
  return points_m;
}

PointCloud UniformNoise(int num_points) {
  std::mt19937 random(4);
  PointCloud cloud;
  for (int i = 0; i < num_points; ++i) {
    cloud.points.emplace_back().position_m =
        Eigen::Vector3d(
            Uniform(&random, -10, 10), Uniform(&random, -10, 10), Uniform(&random, -3, 3))
            .cast<float>();
  }
  return cloud;
}

TEST(FitPlane, IsExactOnAPlane) {
  PointMoments moments;
  const Eigen::Vector3d normal = Eigen::Vector3d(-2, 1, 2) / 3;
  for (const double a : {-1.0, 0.0, 1.0}) {
    for (const double b : {-0.5, 0.5}) {
      moments.Add(-3 * normal + a * Eigen::Vector3d(1, 2, 0) / std::sqrt(5) +
                  b * normal.cross(Eigen::Vector3d(1, 2, 0)) / std::sqrt(5));
    }
  }
  const PlaneFit plane = FitPlane(moments);
  // Of six points: sigma 0.5 along b, sqrt(2/3) along a. The normal looks to the origin.
  EXPECT_NEAR(plane.normal.dot(normal), 1.0, 1e-9);
  EXPECT_NEAR(plane.spread_m[0], 0.0, 1e-6);
  EXPECT_NEAR(plane.spread_m[1], 0.5, 1e-9);
  EXPECT_NEAR(plane.spread_m[2], std::sqrt(2.0 / 3.0), 1e-9);
}

TEST(FindPlanarPatches, FindsARectangleAndNeitherWallNorBush) {
  std::mt19937 random(5);
  std::vector<Eigen::Vector3d> points_m = Rectangle(&random);
  for (int i = 0; i < 8000; ++i) {
    points_m.emplace_back(5.0, Uniform(&random, -4, 4), Uniform(&random, -1, 2));
    points_m.emplace_back(
        Uniform(&random, 2.5, 3.3), Uniform(&random, 2.6, 3.4), Uniform(&random, -0.4, 0.4));
  }
  const auto patches = FindPlanarPatches(points_m, {});
  ASSERT_EQ(patches.size(), 1U);
  EXPECT_EQ(patches.front().num_points, 800);
  // The rectangle's mean, to the spread of its cells' means.
  EXPECT_LT((patches.front().middle_m - Eigen::Vector3d(2, 0, 0)).norm(), 0.03);
}

TEST(FindPlanarPatches, LeavesOutAPoleInThePlane) {
  std::mt19937 random(7);
  std::vector<Eigen::Vector3d> points_m = Rectangle(&random);
  for (int i = 0; i < 80; ++i) points_m.emplace_back(2.0, 0.0, Uniform(&random, -1.4, -0.42));
  const auto patches = FindPlanarPatches(points_m, {});
  ASSERT_EQ(patches.size(), 1U);
  // What of the pole is within 0.7 m of the middle stays, three cells of about thirty: they draw
  // the mean of the cells' means down by a tenth of half a metre.
  EXPECT_LT((patches.front().middle_m - Eigen::Vector3d(2, 0, 0)).norm(), 0.06);
  EXPECT_LT(patches.front().num_points, 840);
}

TEST(FindPlanarPatches, FindsARectangleThatALongPoleMakesAsLongAsAWall) {
  std::mt19937 random(8);
  std::vector<Eigen::Vector3d> points_m = Rectangle(&random);
  for (int i = 0; i < 300; ++i) points_m.emplace_back(2.0, 0.0, Uniform(&random, -2.1, -0.42));
  const auto patches = FindPlanarPatches(points_m, {});
  ASSERT_EQ(patches.size(), 1U);
  EXPECT_LT((patches.front().middle_m - Eigen::Vector3d(2, 0, 0)).norm(), 0.06);  // as above
}

TEST(BeamIndex, FindsWhatAScanOfAllBeamsFinds) {
  constexpr double kMinRangeM = 0.5;
  const PointCloud cloud = UniformNoise(5000);
  const BeamIndex index(cloud, kMinRangeM);
  std::mt19937 random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d axis =
        Eigen::Vector3d(Uniform(&random, -1, 1), Uniform(&random, -1, 1), Uniform(&random, -2, 2))
            .normalized();
    const double half_angle_rad = Uniform(&random, 0.05, 1.7);
    std::vector<LidarBeam> cone;
    index.AppendCone(axis, half_angle_rad, &cone);
    std::size_t num = 0;
    for (const LidarPoint& point : cloud.points) {
      const Eigen::Vector3d position_m = point.position_m.cast<double>();
      num += position_m.norm() >= kMinRangeM &&
             axis.dot(position_m) > std::cos(half_angle_rad) * position_m.norm();
    }
    EXPECT_EQ(cone.size(), num) << axis.transpose() << ' ' << half_angle_rad;
  }
}

TEST(BeamIndex, CoversWhereOtherReturnsAreAsHighAndSomeHaveTheAzimuth) {
  PointCloud cloud;
  for (int azimuth_deg = -60; azimuth_deg <= 60; ++azimuth_deg) {
    for (const float slope : {-0.2F, 0.0F, 0.2F}) {
      const double azimuth_rad = azimuth_deg * M_PI / 180;
      LidarPoint point;
      point.position_m =
          3.0F * Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), slope).cast<float>();
      cloud.points.push_back(point);
    }
  }
  const BeamIndex index(cloud, 0.5);
  EXPECT_TRUE(index.Covers({2.0, 0.5, 0.3}));
  EXPECT_FALSE(index.Covers({2.0, 0.5, 0.5}));   // higher than any return
  EXPECT_FALSE(index.Covers({2.0, 0.5, -0.5}));  // lower
  EXPECT_FALSE(index.Covers({-2.0, 0.5, 0.0}));  // behind the sensor
}

TEST(IsInShare, TakesEvenlyWhateverThePeriod) {
  for (const std::size_t period : {1U, 2U, 16U, 64U, 128U}) {
    int num = 0;
    for (std::size_t i = 0; i < 128000; i += period) num += IsInShare(i, 12800, 128000);
    // A tenth of each period's points; Weyl sequences stay within a few counts.
    EXPECT_NEAR(num, 12800.0 / static_cast<double>(period), 10.0) << period;
  }
}

TEST(DetectLidarBoard, NoiseHasNoBoard) {
  const BoardSpec board{0.61, 0.85, 0.095, 5, 7, 0.0, 0.0};
  for (const int num_points : {1000, 300000}) {
    EXPECT_FALSE(DetectLidarBoard(UniformNoise(num_points), board, {})) << num_points;
  }
}

}  // namespace
}  // namespace voqcal
