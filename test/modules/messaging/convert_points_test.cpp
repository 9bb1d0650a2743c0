#include "messaging/convert_points.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kUtime = 1'700'000'000'000'000;

PointCloud Cloud() {
  PointCloud cloud;
  cloud.has_intensity = true;
  cloud.has_ring = true;
  cloud.has_time = true;
  cloud.has_return_number = true;
  for (int i = 0; i < 3; ++i) {
    LidarPoint point;
    point.position_m = Eigen::Vector3f(1.1F, -2.2F, 0.3F) * static_cast<float>(i + 1);
    point.intensity = 0.7F * static_cast<float>(i);
    point.ring = static_cast<std::uint16_t>(65535 - i);
    point.time_s = 1e-4F * static_cast<float>(i);
    point.return_number = static_cast<std::uint8_t>(i + 1);
    cloud.points.push_back(point);
  }
  return cloud;
}

void ExpectSame(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.has_intensity, b.has_intensity);
  EXPECT_EQ(a.has_ring, b.has_ring);
  EXPECT_EQ(a.has_time, b.has_time);
  EXPECT_EQ(a.has_return_number, b.has_return_number);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].position_m, b.points[i].position_m);
    EXPECT_EQ(a.points[i].intensity, b.points[i].intensity);
    EXPECT_EQ(a.points[i].ring, b.points[i].ring);
    EXPECT_EQ(a.points[i].time_s, b.points[i].time_s);
    EXPECT_EQ(a.points[i].return_number, b.points[i].return_number);
  }
}

void AddField(const std::string& name, std::int8_t datatype, int offset, pointcloud2_t* message) {
  pointfield_t field{};
  field.name = name;
  field.datatype = datatype;
  field.offset = offset;
  field.count = 1;
  message->fields.push_back(field);
  message->nfields = static_cast<std::int32_t>(message->fields.size());
}

template <typename T>
void Put(T value, bool is_big_endian, std::vector<std::uint8_t>* data) {
  std::uint8_t bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if (is_big_endian) std::reverse(std::begin(bytes), std::end(bytes));
  data->insert(data->end(), std::begin(bytes), std::end(bytes));
}

/// One point (1.5, -2.5, 3.5), ring 12, intensity 200, 2.5 ms, as another driver might send it:
/// time first, FLOAT64 coordinates out of order, "channel", padding.
pointcloud2_t ForeignCloud(bool is_big_endian) {
  pointcloud2_t message{};
  message.utime = kUtime;
  message.width = 1;
  message.height = 1;
  message.is_bigendian = is_big_endian ? 1 : 0;
  AddField("t", 6, 0, &message);
  AddField("z", 8, 4, &message);
  AddField("x", 8, 12, &message);
  AddField("y", 7, 20, &message);
  AddField("intensity", 2, 24, &message);
  AddField("channel", 3, 25, &message);
  Put<std::uint32_t>(2'500'000, is_big_endian, &message.data);
  Put<double>(3.5, is_big_endian, &message.data);
  Put<double>(1.5, is_big_endian, &message.data);
  Put<float>(-2.5F, is_big_endian, &message.data);
  Put<std::uint8_t>(200, is_big_endian, &message.data);
  Put<std::int16_t>(12, is_big_endian, &message.data);
  message.data.resize(32);
  message.point_step = 32;
  message.row_step = 32;
  message.data_nbytes = 32;
  return message;
}

TEST(PointCloudMessage, ComesBackExactly) {
  const PointCloud cloud = Cloud();
  const pointcloud2_t message = ToMessage(cloud, kUtime, 5);
  EXPECT_EQ(message.utime, kUtime);
  EXPECT_EQ(message.seq, 5);
  EXPECT_TRUE(message.is_dense);
  ExpectSame(FromMessage(message), cloud);
}

TEST(PointCloudMessage, CarriesOnlyWhatTheCloudHas) {
  PointCloud cloud = Cloud();
  cloud.has_intensity = cloud.has_ring = cloud.has_time = cloud.has_return_number = false;
  for (LidarPoint& point : cloud.points) {
    point.intensity = 0;
    point.ring = 0;
    point.time_s = 0;
    point.return_number = 0;
  }
  const pointcloud2_t message = ToMessage(cloud, kUtime, 5);
  EXPECT_EQ(message.nfields, 3);
  ExpectSame(FromMessage(message), cloud);
}

TEST(PointCloudMessage, GivesAReturnThatIsThereTwiceOnce) {
  PointCloud twice = Cloud();
  for (const LidarPoint& point : Cloud().points) twice.points.push_back(point);
  ExpectSame(FromMessage(ToMessage(twice, kUtime, 1)), Cloud());
}

TEST(PointCloudMessage, MayBeEmpty) {
  EXPECT_TRUE(FromMessage(ToMessage(PointCloud{}, kUtime, 1)).points.empty());
  EXPECT_TRUE(FromMessage(pointcloud2_t{}).points.empty());
}

TEST(PointCloudMessage, KeepsNan) {
  PointCloud cloud = Cloud();
  cloud.points[1].position_m.y() = std::numeric_limits<float>::quiet_NaN();
  const pointcloud2_t message = ToMessage(cloud, kUtime, 5);
  EXPECT_FALSE(message.is_dense);
  EXPECT_TRUE(std::isnan(FromMessage(message).points[1].position_m.y()));
}

TEST(PointCloudMessage, ReadsOtherDriversLayouts) {
  for (const bool is_big_endian : {false, true}) {
    const PointCloud cloud = FromMessage(ForeignCloud(is_big_endian));
    ASSERT_EQ(cloud.points.size(), 1U);
    EXPECT_EQ(cloud.points[0].position_m, Eigen::Vector3f(1.5F, -2.5F, 3.5F));
    EXPECT_EQ(cloud.points[0].intensity, 200.0F);
    EXPECT_EQ(cloud.points[0].ring, 12);
    EXPECT_FLOAT_EQ(cloud.points[0].time_s, 2.5e-3F);
  }
}

TEST(PointCloudMessage, ReadsTimesSinceTheEpoch) {
  pointcloud2_t message{};
  message.utime = kUtime;
  message.width = message.height = 1;
  for (const char* axis : {"x", "y", "z"}) AddField(axis, 7, 0, &message);
  AddField("timestamp", 8, 4, &message);
  Put<float>(1.0F, false, &message.data);
  Put<double>(1e-6 * kUtime + 0.05, false, &message.data);
  message.point_step = message.row_step = message.data_nbytes = 12;
  // A double of seconds since the epoch resolves 2.4e-7 s.
  EXPECT_NEAR(FromMessage(message).points[0].time_s, 0.05, 1e-6);
}

/// A sweep of 0.1 s whose times count `per_second` from `origin`.
template <typename T>
PointCloud SweepWithTimes(std::int8_t datatype, double per_second, double origin) {
  constexpr int kNumPoints = 11;
  pointcloud2_t message{};
  message.utime = kUtime;
  message.width = kNumPoints;
  message.height = 1;
  for (const char* axis : {"x", "y", "z"}) AddField(axis, 7, 0, &message);
  AddField("time_stamp", datatype, 4, &message);
  for (int i = 0; i < kNumPoints; ++i) {
    Put<float>(1.0F + static_cast<float>(i), false, &message.data);
    Put<T>(static_cast<T>(origin + per_second * 0.01 * i), false, &message.data);
  }
  message.point_step = 4 + static_cast<std::int32_t>(sizeof(T));
  message.row_step = message.data_nbytes = static_cast<std::int32_t>(message.data.size());
  return FromMessage(message);
}

TEST(PointCloudMessage, TellsTheUnitOfTimesByTheirRange) {
  constexpr double kStampS = 1e-6 * kUtime;
  for (const PointCloud& cloud : {SweepWithTimes<std::uint32_t>(6, 1e9, 0),
                                  SweepWithTimes<std::uint32_t>(6, 1e6, 0),
                                  SweepWithTimes<float>(7, 1e3, 0),
                                  SweepWithTimes<double>(8, 1e9, 1e9 * kStampS),
                                  SweepWithTimes<double>(8, 1, kStampS),
                                  SweepWithTimes<double>(8, 1e6, 5e9)}) {  // since the start
    ASSERT_TRUE(cloud.has_time);
    EXPECT_NEAR(cloud.points.front().time_s, 0.0, 1e-6);
    EXPECT_NEAR(cloud.points.back().time_s, 0.1, 1e-6);
  }
  EXPECT_NEAR(SweepWithTimes<float>(7, 1, -0.1).points.front().time_s, -0.1, 1e-6);
  EXPECT_FALSE(SweepWithTimes<double>(8, 1e14, 0).has_time);
}

TEST(PointCloudMessage, ReadsPaddedRows) {
  const PointCloud cloud = Cloud();
  pointcloud2_t message = ToMessage(cloud, kUtime, 5);
  std::vector<std::uint8_t> padded;
  const auto step = static_cast<std::ptrdiff_t>(message.point_step);
  for (std::ptrdiff_t i = 0; i < 3; ++i) {
    padded.insert(
        padded.end(), message.data.begin() + i * step, message.data.begin() + (i + 1) * step);
    if (i < 2) padded.resize(padded.size() + 5);  // the last row need not be padded
  }
  message.width = 1;
  message.height = 3;
  message.row_step = message.point_step + 5;
  message.data = padded;
  message.data_nbytes = static_cast<std::int32_t>(padded.size());
  ExpectSame(FromMessage(message), cloud);
}

TEST(PointCloudMessage, OfOneRowNeedsNoRowStep) {
  pointcloud2_t message = ToMessage(Cloud(), kUtime, 5);
  message.row_step = 0;
  ExpectSame(FromMessage(message), Cloud());
}

TEST(PointCloudMessage, OfManyRowsNeedsNoRowStepEither) {
  pointcloud2_t message = ToMessage(Cloud(), kUtime, 5);
  message.height = message.width;
  message.width = 1;
  message.row_step = 0;
  ExpectSame(FromMessage(message), Cloud());
}

struct Broken {
  std::string what;
  std::function<void(pointcloud2_t*)> breaking;
};

class BrokenPointCloud : public testing::TestWithParam<Broken> {};

TEST_P(BrokenPointCloud, IsRefusedWithItsCause) {
  pointcloud2_t message = ToMessage(Cloud(), kUtime, 5);
  GetParam().breaking(&message);
  try {
    FromMessage(message);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().what));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Causes,
    BrokenPointCloud,
    testing::Values(Broken{"-1 x 1", [](auto* m) { m->width = -1; }},
                    Broken{"x -2", [](auto* m) { m->height = -2; }},
                    Broken{"need", [](auto* m) { m->height = INT32_MAX; }},
                    Broken{"row_step", [](auto* m) { m->width = INT32_MAX; }},
                    Broken{"point_step", [](auto* m) { m->point_step = 0; }},
                    Broken{"row_step", [](auto* m) { m->row_step = 5; }},
                    Broken{"row_step", [](auto* m) { m->row_step = -5; }},
                    Broken{"data_nbytes", [](auto* m) { m->data.pop_back(); }},
                    Broken{"data_nbytes", [](auto* m) { m->data_nbytes = -1; }},
                    Broken{"'x'", [](auto* m) { m->fields[0].name = "w"; }},
                    Broken{"offset -4", [](auto* m) { m->fields[1].offset = -4; }},
                    Broken{"offset 2147483647", [](auto* m) { m->fields[4].offset = INT32_MAX; }},
                    Broken{"datatype 9", [](auto* m) { m->fields[2].datatype = 9; }}));

}  // namespace
}  // namespace voqcal
