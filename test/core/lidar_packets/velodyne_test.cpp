#include "core/lidar_packets/velodyne.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/vlp16_packet.hpp"

namespace voqcal {
namespace {

using test::Vlp16PacketWriter;

constexpr double kDeg = M_PI / 180.0;

Expected<LidarPacket, PacketFault> DecodeVlp16(PacketBytes bytes, const LidarUnit& unit) {
  return MakeVelodyneVlp16(unit)(bytes);
}

// A packet of another model: firings of so many banks of 32 lasers, a block each, two in dual mode.
Vlp16PacketWriter PacketOf(
    std::uint8_t product, int num_banks, int azimuth_cdeg, int step, std::uint8_t mode = 0x37) {
  Vlp16PacketWriter packet(azimuth_cdeg, step, 0, mode);
  const int num_copies = mode == 0x39 ? 2 : 1;
  for (int block = 0; block < 12; ++block) {
    const int bank = block / num_copies % num_banks;
    const int firing = block / num_copies / num_banks;
    packet.Write16(block * 100, 0xEEFF - 0x1100 * bank);
    packet.Write16(block * 100 + 2, (azimuth_cdeg + firing * step) % 36000);
  }
  packet.bytes[1205] = product;
  return packet;
}

Eigen::Vector3d PositionM(double distance_m, double elevation_deg, double azimuth_deg) {
  const double across_m = distance_m * std::cos(elevation_deg * kDeg);
  return {across_m * std::cos(azimuth_deg * kDeg),
          -across_m * std::sin(azimuth_deg * kDeg),
          distance_m * std::sin(elevation_deg * kDeg)};
}

constexpr double kOfAFloatM = 1e-6;

TEST(DecodeVlp16, PutsAnEchoWhereTheManualDoes) {
  Vlp16PacketWriter packet(9000, 40, 123456);
  packet.SetEcho(3, 1, 6, 1000, 77);  // 2 m at -9 degrees
  const auto decoded = DecodeVlp16(packet.Bytes(), {});
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->sensor_us, 123456);
  ASSERT_EQ(decoded->returns.size(), 1U);
  const PacketReturn& echo = decoded->returns[0];
  // Three blocks of 110.592 us, one firing of 55.296 us and six lasers of 2.304 us.
  EXPECT_NEAR(echo.after_packet_us, 3 * 110.592 + 55.296 + 6 * 2.304, 1e-9);
  const double azimuth_rad = (90.0 + 0.4 * (3 + (55.296 + 6 * 2.304) / 110.592)) * kDeg;
  EXPECT_NEAR(echo.azimuth_rad, azimuth_rad, 1e-12);
  EXPECT_EQ(echo.point.ring, 3);
  EXPECT_EQ(echo.point.intensity, 77.0F);
  EXPECT_EQ(echo.distance_m, 2.0);
  EXPECT_EQ(echo.of_how_many, 1);
  const Eigen::Vector3d expected_m(2.0 * std::cos(-9 * kDeg) * std::cos(azimuth_rad),
                                   -2.0 * std::cos(-9 * kDeg) * std::sin(azimuth_rad),
                                   2.0 * std::sin(-9 * kDeg));
  EXPECT_LT((echo.point.position_m.cast<double>() - expected_m).norm(), 1e-6);  // of a float
}

TEST(DecodeVlp16, InterpolatesAcrossNorthAndInTheLastBlock) {
  Vlp16PacketWriter packet(35790, 40, 0);  // blocks 0..5 before north, 6 at 0.3 degrees
  packet.SetEcho(5, 1, 0, 500, 1);
  packet.SetEcho(11, 1, 0, 500, 1);
  const auto decoded = DecodeVlp16(packet.Bytes(), {});
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->returns.size(), 2U);
  EXPECT_NEAR(decoded->returns[0].azimuth_rad, 0.1 * kDeg, 1e-9);  // 359.9 + 0.2
  EXPECT_NEAR(decoded->returns[1].azimuth_rad, 2.5 * kDeg, 1e-9);  // 2.3 + 0.2
}

TEST(DecodeVlp16, TellsTheTwoReturnsApart) {
  Vlp16PacketWriter packet(1000, 40, 0, 0x39);
  packet.SetEcho(4, 0, 2, 900, 10);  // last and strongest differ
  packet.SetEcho(5, 0, 2, 600, 20);
  packet.SetEcho(4, 0, 3, 700, 30);  // the same
  packet.SetEcho(5, 0, 3, 700, 30);
  packet.SetEcho(5, 0, 4, 800, 40);  // one only
  const auto decoded = DecodeVlp16(packet.Bytes(), {});
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->returns.size(), 4U);
  const auto number = [&](int i) {
    return std::make_pair(decoded->returns[i].number, decoded->returns[i].of_how_many);
  };
  EXPECT_EQ(number(0), std::make_pair(1, 2));
  EXPECT_DOUBLE_EQ(decoded->returns[0].distance_m, 1.2);
  EXPECT_EQ(number(1), std::make_pair(2, 2));
  EXPECT_DOUBLE_EQ(decoded->returns[1].distance_m, 1.8);
  EXPECT_EQ(number(2), std::make_pair(1, 1));
  EXPECT_EQ(number(3), std::make_pair(1, 1));
  // Blocks come in pairs: the third pair.
  EXPECT_NEAR(decoded->returns[0].after_packet_us, 2 * 110.592 + 2 * 2.304, 1e-9);
  EXPECT_NEAR(
      decoded->returns[0].azimuth_rad, (10.0 + 0.4 * (2 + 2 * 2.304 / 110.592)) * kDeg, 1e-12);
}

TEST(DecodeVlp16, TakesTheUnitsOwnElevations) {
  Vlp16PacketWriter packet(0, 40, 0);
  packet.SetEcho(0, 0, 1, 1000, 1);  // ring 8
  LidarUnit unit;
  unit.elevations_rad.assign(16, 0.0);
  unit.elevations_rad[8] = 1.2 * kDeg;
  const auto decoded = DecodeVlp16(packet.Bytes(), unit);
  ASSERT_TRUE(decoded);
  const Eigen::Vector3d position_m = decoded->returns.at(0).point.position_m.cast<double>();
  EXPECT_NEAR(std::asin(position_m.z() / position_m.norm()), 1.2 * kDeg, 1e-6);
}

TEST(DecodeVls128, PutsAnEchoWhereTheManualDoes) {
  // 0x63 is the VLS-128 of the manual, 0xA1 the Alpha Prime.
  for (const std::uint8_t product : std::vector<std::uint8_t>{0x63, 0xA1}) {
    Vlp16PacketWriter packet = PacketOf(product, 4, 9000, 20);
    packet.SetEcho(6, 0, 5, 500, 77);  // laser 69 of the second firing: 2 m at -19.582 degrees
    const auto decoded = MakeVelodyneVls128({})(packet.Bytes());
    ASSERT_TRUE(decoded) << ToString(decoded.error());
    ASSERT_EQ(decoded->returns.size(), 1U);
    const PacketReturn& echo = decoded->returns[0];
    const double in_firing_us = 2.665 * (8 + 1);  // the ninth group of eight, behind the pause
    EXPECT_NEAR(echo.after_packet_us, 53.3 + in_firing_us, 1e-9);
    const double head_deg = 90.2 + 0.2 * in_firing_us / 53.3;
    EXPECT_NEAR(echo.azimuth_rad, head_deg * kDeg, 1e-12);
    EXPECT_EQ(echo.point.ring, 1);
    EXPECT_EQ(echo.point.intensity, 77.0F);
    const Eigen::Vector3d expected_m = PositionM(2.0, -19.582, head_deg - 2.732);
    EXPECT_LT((echo.point.position_m.cast<double>() - expected_m).norm(), kOfAFloatM);
  }
  EXPECT_EQ(MakeVelodyneVls128({})(PacketOf(0x28, 4, 9000, 20).Bytes()).error(),
            PacketFault::kAlien);
}

TEST(DecodeVls128, ReadsOneFiringOfTwoReturnsBeforeThePadding) {
  const PacketDecoder decode = MakeVelodyneVls128({});
  const auto packet_at = [](int azimuth_cdeg) {
    Vlp16PacketWriter packet = PacketOf(0xA1, 4, azimuth_cdeg, 20, 0x39);
    std::fill(packet.bytes.begin() + 800, packet.bytes.begin() + 1200, std::uint8_t{0});
    packet.SetEcho(6, 0, 31, 900, 10);  // laser 127, last and strongest
    packet.SetEcho(7, 0, 31, 600, 20);
    return packet;
  };
  ASSERT_TRUE(decode(packet_at(9000).Bytes()));
  const auto decoded = decode(packet_at(9020).Bytes());
  ASSERT_TRUE(decoded) << ToString(decoded.error());
  ASSERT_EQ(decoded->returns.size(), 2U);
  EXPECT_DOUBLE_EQ(decoded->returns[0].distance_m, 2.4);
  EXPECT_DOUBLE_EQ(decoded->returns[1].distance_m, 3.6);
  // The packet before tells how fast the head turns.
  const double head_deg = 90.2 + 0.2 * 2.665 * (15 + 1) / 53.3;
  EXPECT_NEAR(decoded->returns[0].azimuth_rad, head_deg * kDeg, 1e-12);
  const Eigen::Vector3d expected_m = PositionM(2.4, 0.43, head_deg - 6.354);
  EXPECT_LT((decoded->returns[0].point.position_m.cast<double>() - expected_m).norm(), kOfAFloatM);
}

TEST(DecodeHdl32e, PutsAnEchoWhereTheManualDoes) {
  Vlp16PacketWriter packet = PacketOf(0x21, 1, 9000, 16);
  packet.SetEcho(3, 0, 31, 1000, 77);  // 2 m, the highest laser
  const auto decoded = MakeVelodyneHdl32e({})(packet.Bytes());
  ASSERT_TRUE(decoded) << ToString(decoded.error());
  ASSERT_EQ(decoded->returns.size(), 1U);
  const PacketReturn& echo = decoded->returns[0];
  EXPECT_NEAR(echo.after_packet_us, 3 * 46.08 + 31 * 1.152, 1e-9);
  EXPECT_EQ(echo.point.ring, 31);
  const double head_deg = 90.0 + 0.16 * (3 + 31 * 1.152 / 46.08);
  constexpr double kRoundedM = 2.0 * 0.005 * kDeg;  // the manual rounds to 0.01 degrees
  const Eigen::Vector3d expected_m = PositionM(2.0, 10.67, head_deg);
  EXPECT_LT((echo.point.position_m.cast<double>() - expected_m).norm(), kRoundedM);
}

TEST(DecodeVlp16HiRes, HasElevationsOfItsOwn) {
  Vlp16PacketWriter packet = PacketOf(0x24, 1, 0, 0);
  packet.SetEcho(0, 0, 1, 1000, 1);  // ring 8
  const auto decoded = MakeVelodyneVlp16HiRes({})(packet.Bytes());
  ASSERT_TRUE(decoded) << ToString(decoded.error());
  const Eigen::Vector3d position_m = decoded->returns.at(0).point.position_m.cast<double>();
  EXPECT_LT((position_m - PositionM(2.0, 2.0 / 3, 0.0)).norm(), kOfAFloatM);
  EXPECT_FALSE(DecodeVlp16(packet.Bytes(), {}));
}

// The manual's appendix on coordinates, with its x to the right and its y ahead.
TEST(DecodeHdl64e, TakesTheUnitsCalibration) {
  LidarUnit unit;
  unit.calibration = "lasers:\n";
  for (int laser = 0; laser < 64; ++laser) {
    unit.calibration +=
        "- {laser_id: " + std::to_string(laser) +
        ", rot_correction: 0.03, vert_correction: " + std::to_string(0.01 * (laser - 40)) +
        ", dist_correction: 0.5, vert_offset_correction: 0.2, horiz_offset_correction: 0.026}\n";
  }
  Vlp16PacketWriter packet = PacketOf(0, 2, 9000, 16);
  packet.SetEcho(3, 0, 2, 1000, 77);  // laser 34 of the second firing
  const auto decoded = MakeVelodyneHdl64e(unit)(packet.Bytes());
  ASSERT_TRUE(decoded) << ToString(decoded.error());
  ASSERT_EQ(decoded->returns.size(), 1U);
  const PacketReturn& echo = decoded->returns[0];
  EXPECT_EQ(echo.point.ring, 34);
  const double azimuth_rad = echo.azimuth_rad - 0.03;
  EXPECT_NEAR(echo.azimuth_rad, (90.16 + 0.16 * 2 * 1.2 / 46.25) * kDeg, 1e-12);
  constexpr double kElevationRad = 0.01 * (34 - 40);
  const double across_m = 2.5 * std::cos(kElevationRad) - 0.2 * std::sin(kElevationRad);
  const Eigen::Vector3d expected_m(
      across_m * std::cos(azimuth_rad) + 0.026 * std::sin(azimuth_rad),
      -(across_m * std::sin(azimuth_rad) - 0.026 * std::cos(azimuth_rad)),
      2.5 * std::sin(kElevationRad) + 0.2 * std::cos(kElevationRad));
  EXPECT_LT((echo.point.position_m.cast<double>() - expected_m).norm(), kOfAFloatM);
}

TEST(DecodeVlp16, RefusesWhatIsNotADataPacket) {
  const auto fault_after = [](auto change) {
    Vlp16PacketWriter packet(0, 40, 0);
    change(&packet.bytes);
    const auto decoded = DecodeVlp16(packet.Bytes(), {});
    return decoded ? "none" : ToString(decoded.error());
  };
  using Bytes = std::vector<std::uint8_t>*;
  EXPECT_EQ(fault_after([](Bytes bytes) { bytes->resize(512); }), "packets of a wrong size");
  EXPECT_EQ(fault_after([](Bytes bytes) { bytes->clear(); }), "packets of a wrong size");
  EXPECT_EQ(fault_after([](Bytes bytes) { (*bytes)[701] = 0; }), "packets of another sensor");
  EXPECT_EQ(fault_after([](Bytes bytes) { (*bytes)[1205] = 0x21; }), "packets of another sensor");
  EXPECT_EQ(fault_after([](Bytes bytes) { (*bytes)[3] = 0xFF; }), "packets of another sensor");
  EXPECT_EQ(fault_after([](Bytes bytes) { (*bytes)[1203] = 0xFF; }), "packets of another sensor");
  EXPECT_EQ(fault_after([](Bytes bytes) { (*bytes)[1204] = 0x40; }),
            "packets in an unknown return mode");
  EXPECT_EQ(fault_after([](Bytes) {}), "none");
}

}  // namespace
}  // namespace voqcal
