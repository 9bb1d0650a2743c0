// Ouster's own captures against the digests of the fields that its own software decodes, and
// against its manual's formulas.

#include "core/lidar_packets/ouster.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>

#include "core/lidar_packets/ouster_metadata.hpp"
#include "support/capture_file.hpp"
#include "support/real_data.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

std::string Md5(const void* data, std::size_t num_bytes) {
  std::array<unsigned char, 16> digest{};
  EVP_Digest(data, num_bytes, digest.data(), nullptr, EVP_md5(), nullptr);
  std::string text;
  for (const unsigned char byte : digest) {
    char hex[3];
    std::snprintf(hex, sizeof(hex), "%02x", byte);
    text += hex;
  }
  return text;
}

// Ranges of one sweep in millimetres as Ouster's software has them: lines from the top, columns by
// the encoder.
std::vector<std::uint32_t> RangesOf(const TimedSweep& sweep, const OusterMetadata& metadata) {
  const auto width = static_cast<std::size_t>(metadata.columns_of_turn);
  const auto height = static_cast<std::size_t>(metadata.num_pixels);
  std::vector<std::uint32_t> ranges_mm(width * height, 0);
  for (const PacketReturn& echo : sweep.returns) {
    const auto column = static_cast<std::size_t>(
        std::lround(echo.azimuth_rad / (2 * M_PI) * static_cast<double>(width)));
    ranges_mm[(height - 1 - echo.point.ring) * width + column] =
        static_cast<std::uint32_t>(std::lround(1000 * echo.distance_m));
  }
  return ranges_mm;
}

struct Case {
  std::string capture;
  int line_count;
  std::string range_md5;  // of its sweep's RANGE, from Ouster's *_digest.json
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.capture; }

LidarPacketOptions OptionsWith(const std::filesystem::path& metadata) {
  LidarPacketOptions options;
  options.protocol = FindLidarProtocol("ouster");
  options.returns = ReturnChoice::kBoth;
  options.unit.calibration = test::ReadBytes(metadata);
  return options;
}

class OusterCapture : public ::testing::TestWithParam<Case> {};

TEST_P(OusterCapture, HasOustersOwnRanges) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  const auto folder = *data / "packets" / "ouster" / "pcaps";
  const LidarPacketOptions options = OptionsWith(folder / (GetParam().capture + ".json"));
  const auto decoded = test::DecodeCapture(folder / (GetParam().capture + ".pcap"), 7502, options);
  ASSERT_EQ(decoded.sweeps.size(), 1U);
  const OusterMetadata metadata = ReadOusterMetadata(options.unit.calibration);
  EXPECT_EQ(metadata.num_pixels, GetParam().line_count);
  const std::vector<std::uint32_t> ranges_mm = RangesOf(decoded.sweeps[0], metadata);
  EXPECT_EQ(Md5(ranges_mm.data(), sizeof(ranges_mm[0]) * ranges_mm.size()), GetParam().range_md5);
}

INSTANTIATE_TEST_SUITE_P(
    All,
    OusterCapture,
    ::testing::Values(Case{"OS-1-32-G_v2.1.1_1024x10", 32, "78ec93ed29a99d3bff828f11bed6f540"},
                      Case{"OS-2-32-U0_v2.0.0_1024x10", 32, "fb18f696ae1d06fac0368135a3eb89a9"},
                      Case{"OS-0-128-U1_v2.3.0_1024x10", 128, "04aba38789e3e0ea52c08938b49c0cb1"}));

// RANGE and RANGE2 cannot be told apart once echoes are in the order of their distances; they are
// read from the packets once more, by the manual's offsets.
TEST(OusterCapture, HasBothEchoesOfADualReturn) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  const auto folder = *data / "packets" / "ouster" / "pcaps";
  const std::string name = "OS-0-32-U1_v2.2.0_1024x10";
  const auto packets = test::ReadCapture(folder / (name + ".pcap"), 7502);
  const PacketDecoder decode = MakeOuster(OptionsWith(folder / (name + ".json")).unit);
  std::size_t num_second = 0;
  for (const auto& packet : packets) {
    const auto decoded =
        decode({reinterpret_cast<const std::uint8_t*>(packet.bytes.data()), packet.bytes.size()});
    ASSERT_TRUE(decoded);
    std::size_t next = 0;
    for (std::size_t column = 0; column < 16; ++column) {
      for (std::size_t pixel = 0; pixel < 32; ++pixel) {
        const std::size_t at = 32 + column * (12 + 32 * 16) + 12 + pixel * 16;
        std::vector<long> expected_mm;
        for (const std::size_t word : {at, at + 4}) {
          const long range_mm = test::FieldAt<std::uint32_t>(packet.bytes, word) & 0x7FFFF;
          if (range_mm > 0) expected_mm.push_back(range_mm);
        }
        std::sort(expected_mm.begin(), expected_mm.end());
        num_second += expected_mm.size() == 2;
        for (const long range_mm : expected_mm) {
          ASSERT_LT(next, decoded->returns.size());
          EXPECT_EQ(std::lround(1000 * decoded->returns[next].distance_m), range_mm);
          EXPECT_EQ(decoded->returns[next].point.ring, 31 - pixel);
          ++next;
        }
      }
    }
    EXPECT_EQ(next, decoded->returns.size());
  }
  EXPECT_GT(num_second, 50U);
}

TEST(OusterCapture, ReadsEachProfileThatIsThere) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  const auto folder = *data / "packets" / "ouster" / "pcaps";
  const auto points = [&](const std::string& name, const std::string& metadata, int port) {
    const auto decoded = test::DecodeCapture(
        folder / (name + ".pcap"), port, OptionsWith(folder / (metadata + ".json")));
    std::size_t num_points = 0;
    for (const TimedSweep& sweep : decoded.sweeps) num_points += sweep.returns.size();
    return num_points;
  };
  EXPECT_GT(points("OS-1-128_767798045_1024x10_20230712_120049",
                   "OS-1-128_767798045_1024x10_20230712_120049",
                   7502),
            1000U);
  EXPECT_GT(points("shot_limiting_test", "shot_limiting_test", 7702), 100U);
  EXPECT_GT(points("windowed_frame1", "windowed_frame1_0", 53750), 1000U);
}

// By the manual: the beam leaves 27.67 mm from the axis; half a turn is straight ahead in the
// sensor's frame, which is turned against the lidar's by half a turn.
TEST(DecodeOuster, PutsAnEchoWhereTheManualDoes) {
  const std::string metadata =
      R"({"lidar_mode": "512x10", "beam_altitude_angles": [30, 0], "beam_azimuth_angles": [0, 90],
          "lidar_origin_to_beam_origin_mm": 27.67, "prod_sn": "7",
          "lidar_to_sensor_transform": [-1,0,0,0, 0,-1,0,0, 0,0,1,36.18, 0,0,0,1],
          "data_format": {"pixels_per_column": 2, "columns_per_packet": 1, "columns_per_frame": 512,
                          "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16"}})";
  std::vector<std::uint8_t> bytes(32 + 12 + 2 * 12 + 32, 0);
  const auto write = [&bytes](std::size_t at, std::uint64_t value, int num_bytes) {
    for (int i = 0; i < num_bytes; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
  };
  write(0, 1, 2);     // lidar data
  write(2, 1234, 2);  // frame
  write(7, 7, 5);     // serial number
  write(32, 5000000500, 8);
  write(40, 256, 2);  // half a turn
  write(42, 1, 2);    // valid
  write(44, 2000, 4);
  write(48, 90, 1);
  write(56, 4000, 4);
  write(60, 50, 1);
  const PacketDecoder decode = MakeOuster({metadata, {}, 0.0, {}});
  const auto decoded = decode({bytes.data(), bytes.size()});
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->sensor_us, 5000000);
  EXPECT_EQ(decoded->frame, 1234);
  ASSERT_EQ(decoded->returns.size(), 2U);
  const PacketReturn& up = decoded->returns[0];
  EXPECT_EQ(up.point.ring, 1);
  EXPECT_EQ(up.point.intensity, 90.0F);
  EXPECT_NEAR(up.after_packet_us, 0.5, 1e-9);
  const double along_m = 2.0 - 0.02767;
  const Eigen::Vector3d expected_m(
      along_m * std::cos(M_PI / 6) + 0.02767, 0, along_m * std::sin(M_PI / 6) + 0.03618);
  EXPECT_LT((up.point.position_m.cast<double>() - expected_m).norm(), 1e-6);
  // The second beam points a quarter turn further clockwise: to the right, -y.
  const Eigen::Vector3d aside_m(0.02767, -(4.0 - 0.02767), 0.03618);
  EXPECT_LT((decoded->returns[1].point.position_m.cast<double>() - aside_m).norm(), 1e-6);
  bytes[7] = 8;
  const auto alien = decode({bytes.data(), bytes.size()});
  ASSERT_FALSE(alien);
  EXPECT_EQ(alien.error(), PacketFault::kAlien);
}

std::string MetadataError(const std::string& json) {
  try {
    ReadOusterMetadata(json);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ReadOusterMetadata, SaysWhatIsWrong) {
  EXPECT_THAT(MetadataError("[1, 2"), HasSubstr("is not a sensor's metadata as JSON"));
  EXPECT_THAT(MetadataError("7"), HasSubstr("must be the sensor's metadata"));
  EXPECT_THAT(MetadataError("{}"), HasSubstr("lidar_mode must be as \"1024x10\""));
  EXPECT_THAT(MetadataError(R"({"lidar_mode": "1024x10", "beam_altitude_angles": [1, 2]})"),
              HasSubstr("beam_altitude_angles must be a list of 64 numbers"));
  EXPECT_THAT(MetadataError(R"({"data_format": {"pixels_per_column": 1000}})"),
              HasSubstr("pixels_per_column must be 1 to 256"));
}

TEST(ReadOusterMetadata, ReadsEveryFirmwares) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  int num_read = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(*data / "packets" / "ouster" / "metadata")) {
    if (entry.path().extension() != ".json") continue;
    EXPECT_EQ(MetadataError(test::ReadBytes(entry.path())), "") << entry.path();
    ++num_read;
  }
  EXPECT_EQ(num_read, 26);
}

}  // namespace
}  // namespace voqcal
