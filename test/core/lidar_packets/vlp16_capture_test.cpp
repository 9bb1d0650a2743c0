// A real VLP-16's packets against another decoder's points of one sweep.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/lidar_packets/packet_stream.hpp"
#include "support/real_data.hpp"

namespace voqcal {
namespace {

constexpr char kCapture[] = "vlp16_dual_return.pcap";
constexpr char kReference[] = "vlp16_dual_return_scan4.pcd";

std::string ReadAll(const std::string& name) {
  std::ifstream file(*test::RealDataFolder() / "vlp16-capture" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <typename T>
T Field(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

// Datagrams of a little-endian Ethernet capture without VLAN tags or IP options.
std::vector<TimedSweep> SweepsOfCapture() {
  constexpr std::size_t kHeaders = 14 + 20 + 8;
  const std::string bytes = ReadAll(kCapture);
  LidarPacketOptions options;
  options.split_azimuth_rad = 0.0;
  options.returns = ReturnChoice::kBoth;
  LidarPacketStream stream(options);
  std::vector<TimedSweep> sweeps;
  std::size_t at = 24;
  while (at + 16 <= bytes.size()) {
    const std::int64_t utime = Field<std::uint32_t>(bytes, at) * std::int64_t{1000000} +
                               Field<std::uint32_t>(bytes, at + 4);
    const auto size = Field<std::uint32_t>(bytes, at + 8);
    const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data()) + at + 16;
    for (TimedSweep& sweep : stream.Add({data + kHeaders, size - kHeaders}, utime)) {
      sweeps.push_back(std::move(sweep));
    }
    at += 16 + size;
  }
  for (TimedSweep& sweep : stream.Finish()) sweeps.push_back(std::move(sweep));
  EXPECT_EQ(stream.Counts().at("packets"), 603);
  return sweeps;
}

// Ring, distance in 2 mm, which return of how many.
using Key = std::tuple<int, int, int, int>;
using Keys = std::multiset<Key>;

// Kinds of return in the reference: 6 both the same; of two, 4 and 9 are the farther (the last), 5
// and 10 the nearer.
std::optional<std::pair<int, int>> NumberOf(int return_type) {
  if (return_type == 6) return std::make_pair(1, 1);
  if (return_type == 4 || return_type == 9) return std::make_pair(2, 2);
  if (return_type == 5 || return_type == 10) return std::make_pair(1, 2);
  return std::nullopt;
}

// Layout: x y z f32, intensity u8, return type u8, channel u16, azimuth, elevation, distance f32,
// time u32.
Keys ReferencePoints() {
  const std::string bytes = ReadAll(kReference);
  const std::string marker = "DATA binary\n";
  constexpr std::size_t kStep = 32;
  Keys points;
  for (std::size_t at = bytes.find(marker) + marker.size(); at + kStep <= bytes.size();
       at += kStep) {
    const auto number = NumberOf(static_cast<std::uint8_t>(bytes[at + 13]));
    EXPECT_TRUE(number);
    if (!number) break;
    const int distance = static_cast<int>(std::lround(Field<float>(bytes, at + 24) / 0.002));
    points.emplace(Field<std::uint16_t>(bytes, at + 14), distance, number->first, number->second);
  }
  return points;
}

Keys PointsOf(const TimedSweep& sweep) {
  Keys points;
  for (const PacketReturn& echo : sweep.returns) {
    points.emplace(echo.point.ring,
                   static_cast<int>(std::lround(echo.distance_m / 0.002)),
                   echo.number,
                   echo.of_how_many);
  }
  return points;
}

// Each point of the sweep stands for one of the reference.
int NumFound(const Keys& reference, const Keys& points) {
  std::vector<Key> found;
  std::set_intersection(
      reference.begin(), reference.end(), points.begin(), points.end(), std::back_inserter(found));
  return static_cast<int>(found.size());
}

TEST(Vlp16Capture, HasEveryPointOfTheReferenceByRingDistanceAndReturn) {
  if (!test::RealDataFolder()) GTEST_SKIP() << "no real data on this machine";
  const Keys reference = ReferencePoints();
  ASSERT_EQ(reference.size(), 14831U);
  int num_found = 0;
  std::size_t num_of_sweep = 0;
  for (const TimedSweep& sweep : SweepsOfCapture()) {
    const int num = NumFound(reference, PointsOf(sweep));
    if (num <= num_found) continue;
    num_found = num;
    num_of_sweep = sweep.returns.size();
  }
  EXPECT_EQ(num_found, 14831);
  std::cout << num_found << " of 14831 found, of " << num_of_sweep << " in the sweep\n";
}

}  // namespace
}  // namespace voqcal
