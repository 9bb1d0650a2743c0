// Models without a capture: packets written from the user manuals' tables. The others are in
// reference_capture_test.cpp.
#include "core/lidar_packets/hesai.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

constexpr double kDeg = M_PI / 180.0;
constexpr double kOfAFloatM = 1e-6;

// A data packet without echoes, distances in units of 4 mm; azimuths in centidegrees.
struct HesaiPacket {
  std::vector<std::uint8_t> bytes;
  int num_lasers;
  int echo_bytes;

  HesaiPacket(std::size_t num_bytes, int lasers, int num_blocks, int bytes_of_echo)
      : bytes(num_bytes, 0), num_lasers(lasers), echo_bytes(bytes_of_echo) {
    const int header[] = {0xEE, 0xFF, 6, 1, 0, 0, num_lasers, num_blocks, 0, 4};
    std::copy(std::begin(header), std::end(header), bytes.begin());
  }
  // 2023-11-14 22:13:20 and 123456 us: 1700000000 s after the epoch.
  void SetTail(std::size_t mode_at, std::uint8_t mode, std::size_t date_at, std::size_t time_at) {
    bytes[mode_at] = mode;
    const int date[] = {123, 11, 14, 22, 13, 20};
    std::copy(std::begin(date), std::end(date), bytes.begin() + static_cast<long>(date_at));
    for (int i = 0; i < 4; ++i) bytes[time_at + i] = static_cast<std::uint8_t>(123456 >> (8 * i));
  }
  std::size_t BlockAt(int block) const { return 12 + block * (2 + num_lasers * echo_bytes); }
  void SetAzimuth(int block, int azimuth_cdeg) { Write16(BlockAt(block), azimuth_cdeg); }
  void SetEcho(int block, int channel, int distance_4mm, int intensity) {
    const std::size_t at = BlockAt(block) + 2 + channel * echo_bytes;
    Write16(at, distance_4mm);
    bytes[at + 2] = static_cast<std::uint8_t>(intensity);
  }
  void Write16(std::size_t at, int value) {
    bytes[at] = static_cast<std::uint8_t>(value & 0xff);
    bytes[at + 1] = static_cast<std::uint8_t>(value >> 8);
  }
  PacketBytes Bytes() const { return {bytes.data(), bytes.size()}; }
};

// Azimuth 0 is along y.
Eigen::Vector3d PositionM(double distance_m, double elevation_deg, double azimuth_deg) {
  const double across_m = distance_m * std::cos(elevation_deg * kDeg);
  return {across_m * std::sin(azimuth_deg * kDeg),
          across_m * std::cos(azimuth_deg * kDeg),
          distance_m * std::sin(elevation_deg * kDeg)};
}

HesaiPacket Xt32mPacket(std::uint8_t mode) {
  HesaiPacket packet(820, 32, 6, 4);
  packet.SetTail(802, mode, 805, 811);
  packet.bytes[816] = 42;  // its number
  for (int block = 0; block < 6; ++block) {
    packet.SetAzimuth(block, 9000 + 18 * (mode == 0x39 ? block / 2 : block));
  }
  return packet;
}

TEST(DecodeHesaiXt32m, PutsAnEchoWhereTheManualDoes) {
  HesaiPacket packet = Xt32mPacket(0x37);
  packet.SetEcho(3, 18, 500, 77);  // 2 m at -3.905 degrees
  const auto decoded = MakeHesaiXt32m({})(packet.Bytes());
  ASSERT_TRUE(decoded) << ToString(decoded.error());
  EXPECT_EQ(decoded->sensor_us, 1700000000123456);
  EXPECT_EQ(decoded->number, 42U);
  ASSERT_EQ(decoded->returns.size(), 1U);
  const PacketReturn& echo = decoded->returns[0];
  // Two blocks before the last one; two lasers fire at once, 16 apart.
  EXPECT_NEAR(echo.after_packet_us, 5.632 - 2 * 50.0 + 0.368 + 2 * 2.888, 1e-9);
  EXPECT_EQ(echo.point.ring, 13);
  EXPECT_EQ(echo.point.intensity, 77.0F);
  const Eigen::Vector3d expected_m = PositionM(2.0, -3.905, 90.54 - 0.061);
  EXPECT_LT((echo.point.position_m.cast<double>() - expected_m).norm(), kOfAFloatM);
}

TEST(DecodeHesaiXt32m, ReadsTwoReturnsAndTheUnitsAngles) {
  std::string file = "Channel,Elevation,Azimuth\n";
  for (int i = 1; i <= 32; ++i) file += std::to_string(i) + "," + std::to_string(20 - i) + ",0.5\n";
  HesaiPacket packet = Xt32mPacket(0x39);
  packet.SetEcho(4, 9, 750, 10);
  packet.SetEcho(5, 9, 500, 20);
  const auto decoded = MakeHesaiXt32m({file, {}, 0.0, {}})(packet.Bytes());
  ASSERT_TRUE(decoded) << ToString(decoded.error());
  ASSERT_EQ(decoded->returns.size(), 2U);
  EXPECT_EQ(decoded->returns[0].number, 1);
  EXPECT_DOUBLE_EQ(decoded->returns[1].distance_m, 3.0);
  EXPECT_EQ(decoded->returns[1].point.intensity, 10.0F);
  EXPECT_NEAR(decoded->returns[1].after_packet_us, 5.632 + 0.368 + 9 * 2.888, 1e-9);
  const Eigen::Vector3d expected_m = PositionM(3.0, 10.0, 90.36 + 0.5);
  EXPECT_LT((decoded->returns[1].point.position_m.cast<double>() - expected_m).norm(), kOfAFloatM);
}

TEST(DecodeHesaiOt128, PutsAnEchoWhereTheManualDoes) {
  HesaiPacket packet(861, 128, 2, 3);
  packet.SetTail(805 + 12, 0x37, 805 + 15, 805 + 21);
  packet.SetAzimuth(0, 9000);
  packet.SetAzimuth(1, 9010);
  packet.SetEcho(1, 127, 500, 77);  // 2 m at -24.71 degrees
  packet.SetEcho(1, 126, 3, 0);     // a code for why there is none
  const auto decoded = MakeHesaiOt128({})(packet.Bytes());
  ASSERT_TRUE(decoded) << ToString(decoded.error());
  EXPECT_EQ(decoded->sensor_us, 1700000000123456);
  ASSERT_EQ(decoded->returns.size(), 1U);
  EXPECT_EQ(decoded->returns[0].point.ring, 0);
  const Eigen::Vector3d expected_m = PositionM(2.0, -24.71, 90.1 + 0.302);
  EXPECT_LT((decoded->returns[0].point.position_m.cast<double>() - expected_m).norm(), kOfAFloatM);
}

TEST(DecodeHesai, RefusesWhatIsNotADataPacket) {
  HesaiPacket packet = Xt32mPacket(0x37);
  EXPECT_EQ(MakeHesaiXt32({})(packet.Bytes()).error(), PacketFault::kWrongSize);
  packet.bytes[802] = 0x12;
  EXPECT_EQ(MakeHesaiXt32m({})(packet.Bytes()).error(), PacketFault::kUnknownMode);
  packet.bytes[7] = 8;
  EXPECT_EQ(MakeHesaiXt32m({})(packet.Bytes()).error(), PacketFault::kAlien);
}

}  // namespace
}  // namespace voqcal
