// A real VLP-16's capture through the whole driver, against another decoder's points of one sweep.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "lidar_driver/lidar_driver_node.hpp"
#include "messaging/convert_points.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/real_data.hpp"

namespace voqcal {
namespace {

// Ring and distance in 2 mm.
using Keys = std::multiset<std::pair<int, int>>;

template <typename T>
T Field(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

// Layout and kinds of return: see vlp16_capture_test.cpp. 5 and 10 are not the last of two.
Keys ReferencePoints(ReturnChoice returns) {
  std::ifstream file(*test::RealDataFolder() / "vlp16-capture/vlp16_dual_return_scan4.pcd",
                     std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const std::string marker = "DATA binary\n";
  constexpr std::size_t kStep = 32;
  Keys points;
  for (std::size_t at = bytes.find(marker) + marker.size(); at + kStep <= bytes.size();
       at += kStep) {
    const int kind = static_cast<std::uint8_t>(bytes[at + 13]);
    if (returns == ReturnChoice::kLast && (kind == 5 || kind == 10)) continue;
    points.emplace(Field<std::uint16_t>(bytes, at + 14),
                   static_cast<int>(std::lround(Field<float>(bytes, at + 24) / 0.002)));
  }
  return points;
}

Keys PointsOf(const pointcloud2_t& message) {
  Keys points;
  for (const LidarPoint& point : FromMessage(message).points) {
    points.emplace(point.ring, static_cast<int>(std::lround(point.position_m.norm() / 0.002)));
  }
  return points;
}

// The sweep that holds most of the reference's points, and how many.
std::pair<std::size_t, std::size_t> FoundByTheDriver(ReturnChoice returns) {
  Rig rig = test::TestRig();
  rig.lidar_driver.source = LidarDriverOptions::Source::kSensor;
  rig.lidar_sensor.pcap = *test::RealDataFolder() / "vlp16-capture/vlp16_dual_return.pcap";
  rig.lidar_sensor.is_unpaced = true;
  rig.lidar_sensor.packets.split_azimuth_rad = 0.0;
  rig.lidar_sensor.packets.returns = returns;
  Bus bus("memq://");
  test::Inbox<pointcloud2_t> clouds(&bus, rig.channels.lidar_points);
  LidarDriverNode node(rig, &bus);
  while (!node.IsDone()) {
    node.Step();
    test::HandleAll(&bus);
  }
  EXPECT_EQ(node.counters().at("packets"), 603);
  const Keys reference = ReferencePoints(returns);
  std::size_t num_found = 0;
  for (const pointcloud2_t& message : clouds.messages) {
    const Keys points = PointsOf(message);
    std::vector<Keys::value_type> found;
    std::set_intersection(reference.begin(),
                          reference.end(),
                          points.begin(),
                          points.end(),
                          std::back_inserter(found));
    num_found = std::max(num_found, found.size());
  }
  return {num_found, reference.size()};
}

TEST(Vlp16CaptureDriver, FindsEveryPointOfTheReference) {
  if (!test::RealDataFolder()) GTEST_SKIP() << "no real data on this machine";
  const auto [num_found, num_reference] = FoundByTheDriver(ReturnChoice::kBoth);
  EXPECT_EQ(num_reference, 14831U);
  EXPECT_EQ(num_found, num_reference);
}

TEST(Vlp16CaptureDriver, FindsEveryLastReturnOfTheReferenceWhereOnlyThoseAreKept) {
  if (!test::RealDataFolder()) GTEST_SKIP() << "no real data on this machine";
  const auto [num_found, num_reference] = FoundByTheDriver(ReturnChoice::kLast);
  EXPECT_EQ(num_found, num_reference);
}

}  // namespace
}  // namespace voqcal
