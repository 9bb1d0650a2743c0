#include "core/lidar_packets/spectrum_scan.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/spectrum_packet.hpp"

namespace voqcal {
namespace {

constexpr double kDeg = M_PI / 180.0;

using Point = test::SpectrumPoint;
using test::SpectrumVersionOne;
using test::SpectrumVersionZero;

Expected<LidarPacket, PacketFault> Decode(const std::vector<std::uint8_t>& bytes) {
  return DecodeSpectrumScan({bytes.data(), bytes.size()});
}

void ExpectAt(const PacketReturn& echo, double theta_deg, double phi_deg, double distance_m) {
  const double azimuth_rad = (theta_deg - 90.0) * kDeg;
  const Eigen::Vector3d expected_m(distance_m * std::cos(phi_deg * kDeg) * std::cos(azimuth_rad),
                                   distance_m * std::cos(phi_deg * kDeg) * std::sin(azimuth_rad),
                                   distance_m * std::sin(phi_deg * kDeg));
  EXPECT_LT((echo.point.position_m.cast<double>() - expected_m).norm(), 1e-5);  // of a float
}

TEST(DecodeSpectrumScan, ReadsVersionOneBitByBit) {
  const auto decoded = Decode(SpectrumVersionOne(4000000000U,
                                                 500,
                                                 {{10, 40.0, -12.5, 7500, 200},
                                                  {250, 90.0, 3.21, 524286, 1},
                                                  {260, 144.99, 12.5, 1, 255},
                                                  {515, 60.0, 0.0, 2000, 9}}));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->sensor_us, 4000000000U);
  ASSERT_EQ(decoded->returns.size(), 4U);  // the others have no distance
  ExpectAt(decoded->returns[0], 40.0, -12.5, 7.5);
  ExpectAt(decoded->returns[2], 144.99, 12.5, 0.001);
  EXPECT_NEAR(decoded->returns[1].distance_m, 524.286, 1e-9);
  EXPECT_EQ(decoded->returns[0].point.intensity, 200.0F);
  EXPECT_EQ(decoded->returns[2].point.intensity, 255.0F);
  // 8 * 500 / 1000 = 4 us a tick, counted on past 256 twice.
  EXPECT_NEAR(decoded->returns[0].after_packet_us, 40.0, 1e-9);
  EXPECT_NEAR(decoded->returns[2].after_packet_us, 1040.0, 1e-9);
  EXPECT_NEAR(decoded->returns[3].after_packet_us, 2060.0, 1e-9);
}

TEST(DecodeSpectrumScan, ReadsVersionZero) {
  const auto decoded = Decode(SpectrumVersionZero(
      0xfffffff0U,
      {{0, 35.1234, -7.5, 3210, 8}, {32, 90.0, 0.0, 0, 0}, {40, 91.0, 12.0001, 70000, 9}}));
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->returns.size(), 2U);
  ExpectAt(decoded->returns[0], 35.1234, -7.5, 3.21);
  ExpectAt(decoded->returns[1], 91.0, 12.0001, 70.0);
  EXPECT_EQ(decoded->returns[1].after_packet_us, 40.0);  // past the clock's wrap
}

TEST(DecodeSpectrumScan, RefusesWhatIsNeither) {
  auto bytes = SpectrumVersionOne(0, 500, {});
  bytes[0] = 2;
  EXPECT_EQ(Decode(bytes).error(), PacketFault::kAlien);
  bytes.pop_back();
  EXPECT_EQ(Decode(bytes).error(), PacketFault::kWrongSize);
  EXPECT_EQ(Decode({}).error(), PacketFault::kWrongSize);
  bytes = SpectrumVersionZero(0, {{}, {}});
  bytes.pop_back();
  EXPECT_EQ(Decode(bytes).error(), PacketFault::kWrongSize);
  bytes[14] = 0xff;  // more points than there are bytes
  EXPECT_EQ(Decode(bytes).error(), PacketFault::kWrongSize);
}

}  // namespace
}  // namespace voqcal
