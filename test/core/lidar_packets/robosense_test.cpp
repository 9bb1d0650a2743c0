// Packets written from the user manuals' tables.
#include "core/lidar_packets/robosense.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/lidar_packets/packet_stream.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

constexpr double kDeg = M_PI / 180.0;

void WriteBig(std::vector<std::uint8_t>* bytes,
              std::size_t at,
              std::uint64_t value,
              int num_bytes) {
  for (int i = 0; i < num_bytes; ++i) {
    (*bytes)[at + i] = static_cast<std::uint8_t>(value >> 8 * (num_bytes - 1 - i));
  }
}

// A data packet without echoes; azimuths in centidegrees.
struct DataPacket {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(1248, 0);

  DataPacket(int azimuth, int step, bool is_dual) {
    const std::uint8_t mark[] = {0x55, 0xAA, 0x05, 0x0A, 0x5A, 0xA5, 0x50, 0xA0};
    std::copy(std::begin(mark), std::end(mark), bytes.begin());
    // 2023-11-14 22:13:20, 7 ms and 9 us: 1700000000 s after the epoch.
    const std::uint8_t time[] = {23, 11, 14, 22, 13, 20, 0, 7, 0, 9};
    std::copy(std::begin(time), std::end(time), bytes.begin() + 20);
    for (int block = 0; block < 12; ++block) {
      WriteBig(&bytes, 42 + 100 * block, 0xFFEE, 2);
      WriteBig(
          &bytes, 44 + 100 * block, (azimuth + step * (is_dual ? block / 2 : block)) % 36000, 2);
    }
  }
  void SetEcho(int block, int channel, int distance, int intensity) {
    const std::size_t at = 46 + 100 * block + 3 * channel;
    WriteBig(&bytes, at, distance, 2);
    bytes[at + 2] = static_cast<std::uint8_t>(intensity);
  }
  PacketBytes Bytes() const { return {bytes.data(), bytes.size()}; }
};

// The state packet of a sensor of 32 lasers: 10 degrees down, each 0.5 higher than the one before,
// and 1 degree to the left.
std::vector<std::uint8_t> StatePacket() {
  std::vector<std::uint8_t> bytes(1248, 0);
  const std::uint8_t mark[] = {0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
  std::copy(std::begin(mark), std::end(mark), bytes.begin());
  bytes[300] = 1;  // the strongest return
  for (int laser = 0; laser < 32; ++laser) {
    const int elevation = -1000 + 50 * laser;
    bytes[468 + 3 * laser] = static_cast<std::uint8_t>(elevation < 0);
    WriteBig(&bytes, 469 + 3 * laser, std::abs(elevation), 2);
    bytes[468 + 96 + 3 * laser] = 1;
    WriteBig(&bytes, 469 + 96 + 3 * laser, 100, 2);
  }
  return bytes;
}

TEST(DecodeRobosense16, PutsAnEchoWhereTheManualDoes) {
  DataPacket packet(9000, 40, false);
  packet.SetEcho(3, 16 + 8, 400, 77);  // 2 m, second firing, laser 8: 15 degrees up
  const auto decoded = MakeRobosense16({})(packet.Bytes());
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->sensor_us, 1700000000007009);
  ASSERT_EQ(decoded->returns.size(), 1U);
  const PacketReturn& echo = decoded->returns[0];
  const double in_block_us = 55.54 + 8 * 2.8;
  EXPECT_NEAR(echo.after_packet_us, 3 * 2 * 55.54 + in_block_us, 1e-9);
  const double azimuth_rad = (90.0 + 0.4 * (3 + in_block_us / (2 * 55.54))) * kDeg;
  EXPECT_NEAR(echo.azimuth_rad, azimuth_rad, 1e-9);
  EXPECT_EQ(echo.point.ring, 15);
  EXPECT_EQ(echo.point.intensity, 77.0F);
  const double across_m = 2.0 * std::cos(15 * kDeg) + 0.03825;
  const Eigen::Vector3d expected_m(across_m * std::cos(azimuth_rad),
                                   -across_m * std::sin(azimuth_rad),
                                   2.0 * std::sin(15 * kDeg));
  EXPECT_LT((echo.point.position_m.cast<double>() - expected_m).norm(), 1e-6);
}

TEST(DecodeRobosense32, LearnsItsAnglesFromTheSensor) {
  DataPacket packet(0, 40, true);
  packet.SetEcho(4, 20, 1000, 10);  // 5 m and 3 m, third pair of blocks
  packet.SetEcho(5, 20, 600, 90);
  const PacketDecoder decode = MakeRobosense32({});
  const auto early = decode(packet.Bytes());
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error(), PacketFault::kWithoutCalibration);
  const auto state = StatePacket();
  EXPECT_FALSE(decode({state.data(), state.size()}));
  const auto decoded = decode(packet.Bytes());
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->returns.size(), 2U);
  EXPECT_DOUBLE_EQ(decoded->returns[0].distance_m, 3.0);
  EXPECT_EQ(decoded->returns[0].point.intensity, 90.0F);
  EXPECT_DOUBLE_EQ(decoded->returns[1].distance_m, 5.0);
  EXPECT_EQ(decoded->returns[1].number, 2);
  EXPECT_EQ(decoded->returns[1].point.ring, 20);
  // Laser 20 fires 9 * 1.44 us into its block, level, a degree to the left.
  const double in_block_us = 1.44 * 9;
  const double head_deg = 0.4 * (2 + in_block_us / 55.52);
  EXPECT_NEAR(decoded->returns[1].azimuth_rad, (359.0 + head_deg) * kDeg, 1e-9);
  EXPECT_NEAR(decoded->returns[1].point.position_m.z(), 0.0, 1e-6);
  EXPECT_NEAR(decoded->returns[1].after_packet_us, 2 * 55.52 + in_block_us, 1e-9);
}

TEST(DecodeRobosense32, SaysWhatItLacks) {
  LidarPacketOptions options;
  options.protocol = FindLidarProtocol("robosense_32");
  LidarPacketStream stream(options);
  stream.Add(DataPacket(0, 40, false).Bytes(), 1700000000000000);
  EXPECT_THAT(stream.WrongLidar(), HasSubstr("no calibration of this RoboSense RS-LiDAR-32 came"));
}

TEST(DecodeRobosenseBpearl, TakesTheAngleFile) {
  std::string file;
  for (int laser = 0; laser < 32; ++laser) file += std::to_string(2.5 * laser + 2) + ",0.5\n";
  DataPacket packet(0, 40, false);
  packet.SetEcho(0, 31, 1000, 10);
  const auto decoded = MakeRobosenseBpearl({file, {}, 0.0, {}})(packet.Bytes());
  ASSERT_TRUE(decoded);
  const Eigen::Vector3d position_m = decoded->returns.at(0).point.position_m.cast<double>();
  EXPECT_NEAR(position_m.z(), 5.0 * std::sin(79.5 * kDeg), 1e-5);
  EXPECT_THROW(MakeRobosenseBpearl({"1,2\n3,4\n", {}, 0.0, {}}), std::invalid_argument);
}

// The height of an echo of laser 31 at 5 m, after a state packet (which has the laser at 5.5
// degrees).
double HeightAfterStatePacket(const LidarUnit& unit) {
  const PacketDecoder decode = MakeRobosense32(unit);
  const auto state = StatePacket();
  EXPECT_FALSE(decode({state.data(), state.size()}));
  DataPacket packet(0, 40, false);
  packet.SetEcho(0, 31, 1000, 10);
  const auto decoded = decode(packet.Bytes());
  return decoded ? decoded->returns.at(0).point.position_m.z() : std::nan("");
}

TEST(DecodeRobosense32, KeepsTheUsersAnglesWhateverTheSensorSays) {
  std::string file;
  for (int laser = 0; laser < 32; ++laser) file += std::to_string(-20 + laser) + ",0\n";
  EXPECT_NEAR(HeightAfterStatePacket({}), 5.0 * std::sin(5.5 * kDeg), 1e-5);
  EXPECT_NEAR(HeightAfterStatePacket({file, {}, 0.0, {}}), 5.0 * std::sin(11.0 * kDeg), 1e-5);
  std::vector<double> elevations_rad;
  for (int ring = 0; ring < 32; ++ring) elevations_rad.push_back((-30 + ring) * kDeg);
  EXPECT_NEAR(
      HeightAfterStatePacket({{}, elevations_rad, 0.0, {}}), 5.0 * std::sin(1.0 * kDeg), 1e-5);
}

TEST(DecodeRobosenseHelios, CountsSecondsAndFinerRanges) {
  DataPacket packet(0, 40, false);
  WriteBig(&packet.bytes, 3, 0x5A, 1);
  WriteBig(&packet.bytes, 20, 1700000000, 6);
  WriteBig(&packet.bytes, 26, 123456, 4);
  packet.SetEcho(0, 0, 1000, 10);
  const PacketDecoder decode = MakeRobosenseHelios({});
  const auto state = StatePacket();
  EXPECT_FALSE(decode({state.data(), state.size()}));
  const auto decoded = decode(packet.Bytes());
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->sensor_us, 1700000000123456);
  EXPECT_DOUBLE_EQ(decoded->returns.at(0).distance_m, 2.5);
  EXPECT_EQ(MakeRobosense32({})(packet.Bytes()).error(), PacketFault::kAlien);
}

}  // namespace
}  // namespace voqcal
