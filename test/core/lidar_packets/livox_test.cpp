// Packets written from Livox' protocol documents.
#include "core/lidar_packets/livox.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/lidar_packets/packet_stream.hpp"

namespace voqcal {
namespace {

class Writer {
 public:
  Writer& Put(std::int64_t value, int num_bytes) {
    for (int i = 0; i < num_bytes; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> 8 * i));
    return *this;
  }
  PacketBytes Bytes() const { return {bytes_.data(), bytes_.size()}; }

 private:
  std::vector<std::uint8_t> bytes_;
};

// The header of a Mid-360's or HAP's packet of `num_points`, 10 us apart.
Writer Sdk2(int kind, int num_points, int point_bytes, std::int64_t time_ns) {
  Writer writer;
  writer.Put(0, 1).Put(36 + num_points * point_bytes, 2).Put(100 * num_points, 2);
  writer.Put(num_points, 2).Put(7, 2).Put(0, 1).Put(kind, 1).Put(0, 1);
  for (int i = 0; i < 12; ++i) writer.Put(0, 1);
  return writer.Put(0, 4).Put(time_ns, 8);
}

TEST(DecodeLivoxMid360, ReadsMillimetresAndTimes) {
  Writer writer = Sdk2(1, 3, 14, 1700000000123456789);
  writer.Put(1000, 4).Put(-2000, 4).Put(300, 4).Put(80, 1).Put(0, 1);
  for (int i = 0; i < 14; ++i) writer.Put(0, 1);  // no echo
  writer.Put(-5, 4).Put(6, 4).Put(-7, 4).Put(90, 1).Put(0, 1);
  const auto decoded = MakeLivoxMid360({})(writer.Bytes());
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->sensor_us, 1700000000123456);
  ASSERT_EQ(decoded->returns.size(), 2U);
  EXPECT_EQ(decoded->returns[0].point.position_m, Eigen::Vector3f(1.0F, -2.0F, 0.3F));
  EXPECT_EQ(decoded->returns[0].point.intensity, 80.0F);
  EXPECT_EQ(decoded->returns[1].point.position_m, Eigen::Vector3f(-0.005F, 0.006F, -0.007F));
  EXPECT_NEAR(decoded->returns[1].after_packet_us, 20.0, 1e-9);
}

TEST(DecodeLivoxMid360, ReadsCentimetresAndAngles) {
  Writer low = Sdk2(2, 1, 8, 1);
  low.Put(100, 2).Put(-200, 2).Put(3, 2).Put(80, 1).Put(0, 1);
  const auto from_low = MakeLivoxMid360({})(low.Bytes());
  ASSERT_TRUE(from_low);
  EXPECT_EQ(from_low->returns.at(0).point.position_m, Eigen::Vector3f(1.0F, -2.0F, 0.03F));
  Writer spherical = Sdk2(3, 1, 10, 1);
  spherical.Put(2000, 4).Put(9000, 2).Put(27000, 2).Put(80, 1).Put(0, 1);  // level, to the right
  const auto decoded = MakeLivoxMid360({})(spherical.Bytes());
  ASSERT_TRUE(decoded);
  EXPECT_LT((decoded->returns.at(0).point.position_m - Eigen::Vector3f(0, -2, 0)).norm(), 1e-6F);
}

TEST(DecodeLivoxMid360, RefusesWhatIsNone) {
  const PacketDecoder decode = MakeLivoxMid360({});
  const auto fault = [&decode](const Writer& writer) { return decode(writer.Bytes()).error(); };
  EXPECT_EQ(fault(Writer()), PacketFault::kWrongSize);
  EXPECT_EQ(fault(Sdk2(1, 1, 14, 1)), PacketFault::kAlien);  // its point is missing
  EXPECT_EQ(fault(Sdk2(0, 0, 0, 1)), PacketFault::kWithoutPoints);
  EXPECT_EQ(fault(Sdk2(9, 0, 0, 1)), PacketFault::kUnknownMode);
}

Writer Sdk1(int kind) {
  Writer writer;
  writer.Put(5, 1).Put(0, 3).Put(0, 4).Put(1, 1).Put(kind, 1);
  return writer.Put(5000000000, 8);
}

TEST(DecodeLivoxAvia, ReadsTwoReturnsOfABeam) {
  Writer writer = Sdk1(4);
  for (int i = 0; i < 48; ++i) {
    writer.Put(1000 + i, 4).Put(0, 4).Put(0, 4).Put(10, 1).Put(0, 1);
    writer.Put(i == 0 ? 0 : 3000, 4).Put(0, 4).Put(0, 4).Put(20, 1).Put(0, 1);
  }
  const auto decoded = MakeLivoxAvia({})(writer.Bytes());
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->sensor_us, 5000000);
  ASSERT_EQ(decoded->returns.size(), 2U * 48 - 1);
  EXPECT_EQ(decoded->returns[0].of_how_many, 1);
  EXPECT_EQ(decoded->returns[2].number, 2);
  EXPECT_EQ(decoded->returns[2].of_how_many, 2);
  EXPECT_NEAR(decoded->returns[2].distance_m, 3.0, 1e-9);
  EXPECT_NEAR(decoded->returns[2].after_packet_us, 1e6 / 240000, 1e-9);
}

TEST(DecodeLivoxAvia, ReadsThreeSphericalReturns) {
  Writer writer = Sdk1(8);
  for (int i = 0; i < 30; ++i) {
    writer.Put(9000, 2).Put(0, 2);  // ahead
    for (int k = 1; k <= 3; ++k) writer.Put(1000 * k, 4).Put(10 * k, 1).Put(0, 1);
  }
  const auto decoded = MakeLivoxAvia({})(writer.Bytes());
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->returns.size(), 90U);
  EXPECT_LT((decoded->returns[2].point.position_m - Eigen::Vector3f(3, 0, 0)).norm(), 1e-6F);
  EXPECT_EQ(decoded->returns[2].point.intensity, 30.0F);
}

TEST(LivoxStream, EndsASweepEvery100Ms) {
  LidarPacketOptions options;
  options.protocol = FindLidarProtocol("livox_mid360");
  LidarPacketStream stream(options);
  std::vector<TimedSweep> sweeps;
  for (int i = 0; i < 250; ++i) {
    Writer writer = Sdk2(1, 1, 14, 1700000000000000000 + i * 1000000LL);
    writer.Put(1000, 4).Put(0, 4).Put(0, 4).Put(80, 1).Put(0, 1);
    for (auto& sweep : stream.Add(writer.Bytes(), 1700000000000000 + i * 1000)) {
      sweeps.push_back(sweep);
    }
  }
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_EQ(sweeps[0].returns.size(), 100U);
  EXPECT_EQ(sweeps[1].utime - sweeps[0].utime, 100000);
}

}  // namespace
}  // namespace voqcal
