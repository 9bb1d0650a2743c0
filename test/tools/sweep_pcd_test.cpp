#include "decode_lidar/sweep_pcd.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/point_cloud_file.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

TEST(SweepPcd, IsWhatTheReaderTakes) {
  TimedSweep sweep;
  sweep.utime = 1700000000123456;
  sweep.returns.resize(2);
  sweep.returns[1].point = {{1.0F, -2.0F, 3.0F}, 77.0F, 300, 0, 0.0625F};
  sweep.returns[1].number = 2;
  const std::string text = SweepPcd(sweep);
  EXPECT_THAT(text, ::testing::StartsWith("# utime 1700000000123456\nVERSION 0.7\n"));
  EXPECT_EQ(text.back(), '\x02');
  const test::TemporaryFolder folder;
  const PointCloud cloud = ReadPointCloud(folder.Write("sweep.pcd", text));
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_TRUE(cloud.has_intensity && cloud.has_ring && cloud.has_time && cloud.has_return_number);
  EXPECT_EQ(cloud.points[1].position_m, Eigen::Vector3f(1.0F, -2.0F, 3.0F));
  EXPECT_EQ(cloud.points[1].intensity, 77.0F);
  EXPECT_EQ(cloud.points[1].ring, 300);
  EXPECT_EQ(cloud.points[1].time_s, 0.0625F);
  EXPECT_EQ(cloud.points[1].return_number, 2);
}

}  // namespace
}  // namespace voqcal
