#include "core/lidar/repeated_points.hpp"

#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::ElementsAre;

// So many that places of the table collide.
PointCloud ManyPoints() {
  PointCloud cloud;
  for (int i = 0; i < 20'000; ++i) {
    LidarPoint point;
    point.position_m = Eigen::Vector3f(
        1.0F + 0.001F * static_cast<float>(i % 100), 0.002F * static_cast<float>(i / 100), -0.5F);
    point.intensity = static_cast<float>(i);
    cloud.points.push_back(point);
  }
  return cloud;
}

std::vector<float> Intensities(const PointCloud& cloud) {
  std::vector<float> values;
  for (const LidarPoint& point : cloud.points) values.push_back(point.intensity);
  return values;
}

TEST(DropRepeatedPoints, LeavesACloudWithoutThemAsItIs) {
  PointCloud cloud = ManyPoints();
  EXPECT_EQ(DropRepeatedPoints(&cloud), 0u);
  EXPECT_EQ(Intensities(cloud), Intensities(ManyPoints()));
}

TEST(DropRepeatedPoints, GivesTheSameCloudHoweverThePointsAreRepeated) {
  const PointCloud once = ManyPoints();
  PointCloud in_two_blocks = once;
  in_two_blocks.points.insert(in_two_blocks.points.end(), once.points.begin(), once.points.end());
  PointCloud one_by_one;
  for (const LidarPoint& point : once.points)
    one_by_one.points.insert(one_by_one.points.end(), 3, point);
  EXPECT_EQ(DropRepeatedPoints(&in_two_blocks), once.points.size());
  EXPECT_EQ(DropRepeatedPoints(&one_by_one), 2 * once.points.size());
  EXPECT_EQ(Intensities(in_two_blocks), Intensities(once));
  EXPECT_EQ(Intensities(one_by_one), Intensities(once));
}

TEST(DropRepeatedPoints, KeepsBeamsWithoutAReturn) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  PointCloud cloud;
  for (int i = 0; i < 4; ++i) {
    LidarPoint point;
    if (i < 2) point.position_m.setConstant(kNan);
    point.intensity = static_cast<float>(i);
    cloud.points.push_back(point);
  }
  EXPECT_EQ(DropRepeatedPoints(&cloud), 0u);
  EXPECT_THAT(Intensities(cloud), ElementsAre(0, 1, 2, 3));
}

}  // namespace
}  // namespace voqcal
