#include "core/lidar/cloud_fields.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

/// Points at (1, 2, 3), the second where nothing returned.
PointCloud ThreePoints() {
  PointCloud cloud;
  cloud.points.resize(3);
  for (LidarPoint& point : cloud.points) point.position_m = {1, 2, 3};
  cloud.points[1].position_m = {NAN, NAN, NAN};
  return cloud;
}

TEST(FindField, KnowsUsualNamesInLettersOfEitherSize) {
  EXPECT_EQ(FindField({"x", "Reflectivity"}, "intensity"), 1U);
  EXPECT_EQ(FindField({"i", "x"}, "intensity"), 0U);
  EXPECT_EQ(FindField({"channel", "ring"}, "ring"), 1U);  // the more exact name first
  EXPECT_EQ(FindField({"time_stamp"}, "time"), 0U);
  EXPECT_EQ(FindField({"ReturnNumber"}, "return_number"), 0U);
  EXPECT_EQ(FindField({"scalar_intensity_2", "rings"}, "intensity"), std::nullopt);
  EXPECT_EQ(FindField({}, "x"), std::nullopt);
}

TEST(SetRings, LooksOnlyWhereABeamReturned) {
  for (const double elsewhere : std::vector<double>{NAN, -1.0, 0.5, 1e9}) {
    PointCloud cloud = ThreePoints();
    SetRings({4, elsewhere, 65535}, &cloud);
    EXPECT_TRUE(cloud.has_ring);
    EXPECT_EQ(cloud.points[0].ring, 4);
    EXPECT_EQ(cloud.points[1].ring, 0);
    EXPECT_EQ(cloud.points[2].ring, 65535);
  }
}

TEST(SetRings, ThatAreNoneMakeACloudWithoutRings) {
  for (const double bad : std::vector<double>{NAN, -1.0, 0.5, 65536.0}) {
    PointCloud cloud = ThreePoints();
    SetRings({4, 5, bad}, &cloud);
    EXPECT_FALSE(cloud.has_ring);
    EXPECT_EQ(cloud.points[0].ring, 0);
  }
}

TEST(SetReturnNumbers, LooksOnlyWhereABeamReturned) {
  PointCloud cloud = ThreePoints();
  SetReturnNumbers({1, NAN, 2}, &cloud);
  EXPECT_TRUE(cloud.has_return_number);
  EXPECT_EQ(cloud.points[0].return_number, 1);
  EXPECT_EQ(cloud.points[2].return_number, 2);
}

TEST(SetReturnNumbers, ThatAreNoneMakeACloudWithoutThem) {
  for (const double bad : std::vector<double>{NAN, -1.0, 0.5, 256.0}) {
    PointCloud cloud = ThreePoints();
    SetReturnNumbers({1, 2, bad}, &cloud);
    EXPECT_FALSE(cloud.has_return_number);
    EXPECT_EQ(cloud.points[0].return_number, 0);
  }
}

void ExpectTimesS(const std::vector<double>& times, float first_s, float last_s) {
  PointCloud cloud = ThreePoints();
  SetTimes(times, &cloud);
  ASSERT_TRUE(cloud.has_time);
  EXPECT_NEAR(cloud.points[0].time_s, first_s, 1e-6);
  EXPECT_NEAR(cloud.points[2].time_s, last_s, 1e-6);
}

TEST(SetTimes, TellsTheUnitByTheRange) {
  ExpectTimesS({0, 0.05, 0.1}, 0, 0.1F);
  ExpectTimesS({0, 50, 100}, 0, 0.1F);
  ExpectTimesS({0, 50e3, 100e3}, 0, 0.1F);
  ExpectTimesS({0, NAN, 100e6}, 0, 0.1F);
  ExpectTimesS({-0.1, -0.05, 0}, -0.1F, 0);  // before the stamp
}

TEST(SetTimes, OfAClockCountFromTheFirst) {
  ExpectTimesS({5000, 5000.05, 5000.1}, 0, 0.1F);
  ExpectTimesS({1.7e18, 1.7e18, 1.7e18 + 1e8}, 0, 0.1F);
}

TEST(SetTimes, OfNoUnitAreNone) {
  for (const std::vector<double>& times :
       {std::vector<double>{0, 1e12, 1e13}, {NAN, NAN, NAN}, {1.7e9, 1.7e9, 1.7e9}}) {
    PointCloud cloud = ThreePoints();
    SetTimes(times, &cloud);
    EXPECT_FALSE(cloud.has_time);
  }
}

}  // namespace
}  // namespace voqcal
