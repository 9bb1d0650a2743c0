#include "core/lidar_packets/velodyne.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/vlp16_packet.hpp"

namespace voqcal {
namespace {

using test::Vlp16PacketWriter;

constexpr double kDeg = M_PI / 180.0;

Expected<LidarPacket, PacketFault> DecodeVlp16(PacketBytes bytes, const LidarUnit& unit) {
  return MakeVelodyneVlp16(unit)(bytes);
}

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
