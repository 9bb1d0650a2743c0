// Real lidars' packets against another decoder's points of one sweep: every point of the reference
// is one of ours, and those that we have besides are those that the reference leaves out.
//
// The references have x, y, z alone, from which range and angles follow. What they leave out, by
// their own settings: echoes nearer than `min_range_m`, and of a beam's two echoes one where they
// are less than 0.1 m apart. They end sweeps at azimuth 0, each beam for itself.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/lidar_packets/velodyne.hpp"
#include "support/capture_file.hpp"
#include "support/real_data.hpp"

namespace voqcal {
namespace {

struct Case {
  std::string model;
  std::string reference;
  int num_points = 0;  // of the reference
  double min_range_m = 0.0;
  std::size_t sweep = 0;  // of the capture, which the reference is of
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.model; }

// A point by what decides: its range in millimetres, then its angles.
struct Measured {
  long range_mm = 0;
  double azimuth_deg = 0.0;
  double elevation_deg = 0.0;
};

Measured MeasuredAt(const Eigen::Vector3d& position_m) {
  constexpr double kDegPerRad = 180.0 / M_PI;
  const double range_m = position_m.norm();
  return {std::lround(1000 * range_m),
          std::atan2(position_m.x(), position_m.y()) * kDegPerRad,
          std::asin(position_m.z() / range_m) * kDegPerRad};
}

bool IsSame(const Measured& a, const Measured& b) {
  constexpr double kMaxDeg = 0.01;
  const double turned_deg = std::remainder(a.azimuth_deg - b.azimuth_deg, 360.0);
  return a.range_mm == b.range_mm && std::abs(turned_deg) < kMaxDeg &&
         std::abs(a.elevation_deg - b.elevation_deg) < kMaxDeg;
}

std::vector<Measured> ReferencePoints(const std::filesystem::path& path) {
  const std::string bytes = test::ReadBytes(path);
  const std::string marker = "DATA binary\n";
  std::vector<Measured> points;
  for (std::size_t at = bytes.find(marker) + marker.size(); at + 12 <= bytes.size(); at += 12) {
    points.push_back(MeasuredAt({test::FieldAt<float>(bytes, at),
                                 test::FieldAt<float>(bytes, at + 4),
                                 test::FieldAt<float>(bytes, at + 8)}));
  }
  return points;
}

// Whether the reference's settings leave an echo out: see above. Which one of two that are too
// close it keeps depends on their blocks; of two exactly 0.1 m apart, the rounding of floats
// decides.
enum class Fate { kIn, kOut, kOneOfTwo, kEither };

Fate FateOf(const std::vector<PacketReturn>& returns, std::size_t i, double min_range_m) {
  constexpr double kMinApartM = 0.1;
  constexpr double kRoundingM = 1e-6;
  const PacketReturn& echo = returns[i];
  if (echo.distance_m < min_range_m - kRoundingM) return Fate::kOut;
  if (echo.of_how_many == 1) return Fate::kIn;
  const PacketReturn& other = echo.number == 1 ? returns[i + 1] : returns[i - 1];
  const double apart_m = std::abs(other.distance_m - echo.distance_m);
  if (std::abs(apart_m - kMinApartM) < kRoundingM) return Fate::kEither;
  return apart_m < kMinApartM ? Fate::kOneOfTwo : Fate::kIn;
}

std::vector<Measured> PointsOf(const TimedSweep& sweep, double min_range_m, Fate fate) {
  std::vector<Measured> points;
  for (std::size_t i = 0; i < sweep.returns.size(); ++i) {
    if (FateOf(sweep.returns, i, min_range_m) != fate) continue;
    points.push_back(MeasuredAt(sweep.returns[i].point.position_m.cast<double>()));
  }
  return points;
}

// The points of `reference` that are none of `points`, each of which stands for one.
std::vector<Measured> Missing(std::vector<Measured> points,
                              const std::vector<Measured>& reference) {
  const auto by_range = [](const Measured& a, const Measured& b) {
    return a.range_mm < b.range_mm;
  };
  std::sort(points.begin(), points.end(), by_range);
  std::vector<bool> is_taken(points.size(), false);
  std::vector<Measured> missing;
  for (const Measured& sought : reference) {
    const auto [begin, end] = std::equal_range(points.begin(), points.end(), sought, by_range);
    const auto found = std::find_if(begin, end, [&](const Measured& point) {
      return IsSame(point, sought) && !is_taken[static_cast<std::size_t>(&point - points.data())];
    });
    if (found == end) {
      missing.push_back(sought);
    } else {
      is_taken[static_cast<std::size_t>(found - points.begin())] = true;
    }
  }
  return missing;
}

std::ostream& operator<<(std::ostream& out, const Measured& point) {
  return out << point.range_mm << " mm, azimuth " << point.azimuth_deg << ", elevation "
             << point.elevation_deg;
}

class HesaiCapture : public ::testing::TestWithParam<Case> {};

TEST_P(HesaiCapture, HasTheReferencesPointsAndNoOthers) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  const Case& c = GetParam();
  const std::filesystem::path folder = *data / "packets" / "nebula";
  const auto reference = ReferencePoints(folder / c.reference);
  ASSERT_EQ(reference.size(), static_cast<std::size_t>(c.num_points));
  LidarPacketOptions options;
  options.protocol = FindLidarProtocol(c.model);
  options.split_azimuth_rad = 0.0;
  options.returns = ReturnChoice::kBoth;
  const auto decoded = test::DecodeCapture(folder / (c.model + ".pcap"), 2368, options);
  EXPECT_EQ(decoded.counts.count("packets lost"), 0U);
  EXPECT_EQ(decoded.counts.count("clock restarts"), 0U);
  ASSERT_GT(decoded.sweeps.size(), c.sweep + 1);
  auto points = PointsOf(decoded.sweeps[c.sweep], c.min_range_m, Fate::kIn);
  const auto one_of_two = PointsOf(decoded.sweeps[c.sweep], c.min_range_m, Fate::kOneOfTwo);
  const auto either = PointsOf(decoded.sweeps[c.sweep], c.min_range_m, Fate::kEither);
  const std::size_t num_sure = points.size() + one_of_two.size() / 2 + either.size() / 2;
  EXPECT_LE(num_sure, reference.size());
  EXPECT_GE(num_sure + either.size() / 2, reference.size());
  points.insert(points.end(), one_of_two.begin(), one_of_two.end());
  points.insert(points.end(), either.begin(), either.end());
  // Where sweeps end, a beam may be counted to the one before or after: at exactly 0 degrees
  // (XT16), and the QT128's outermost beam just before it.
  constexpr double kBorderDeg = 0.15;
  for (const std::size_t neighbour : {c.sweep - 1, c.sweep + 1}) {
    for (const Measured& point : PointsOf(decoded.sweeps[neighbour], c.min_range_m, Fate::kIn)) {
      if (std::abs(point.azimuth_deg) < kBorderDeg) points.push_back(point);
    }
  }
  const auto missing = Missing(points, reference);
  EXPECT_TRUE(missing.empty()) << missing.size() << " of " << c.num_points << ", the first at "
                               << missing.front();
}

// The VLP-32C's reference is of the capture's first packets, point for point in their order, but
// for blocks behind its sides. It rounds azimuths to 0.01 degrees, and does not turn the head
// within a packet's last block.
TEST(VelodyneCapture, HasTheVlp32sPointsInTheirOrder) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  const std::filesystem::path folder = *data / "packets" / "nebula";
  const auto reference = ReferencePoints(folder / "velodyne_vlp32_1713492677464078412.pcd");
  ASSERT_EQ(reference.size(), 26216U);
  const PacketDecoder decode = MakeVelodyneVlp32c({});
  constexpr double kBlockUs = 55.296;
  std::size_t i = 0;
  for (const auto& packet : test::ReadCapture(folder / "velodyne_vlp32.pcap", 2368)) {
    const auto decoded =
        decode({reinterpret_cast<const std::uint8_t*>(packet.bytes.data()), packet.bytes.size()});
    ASSERT_TRUE(decoded);
    for (const PacketReturn& echo : decoded->returns) {
      if (i == reference.size()) break;
      const auto block = static_cast<std::size_t>(echo.after_packet_us / kBlockUs + 1e-6);
      const auto block_cdeg = test::FieldAt<std::uint16_t>(packet.bytes, 100 * block + 2);
      if (block_cdeg > 9000 && block_cdeg < 27000) continue;
      const Measured ours = MeasuredAt(echo.point.position_m.cast<double>());
      const Measured& other = reference[i++];
      ASSERT_EQ(ours.range_mm, other.range_mm) << i;
      ASSERT_NEAR(ours.elevation_deg, other.elevation_deg, 0.001) << i;
      ASSERT_NEAR(std::remainder(ours.azimuth_deg - other.azimuth_deg, 360.0),
                  0.0,
                  block == 11 ? 0.3 : 0.01)
          << i;
    }
  }
  EXPECT_EQ(i, reference.size());
}

INSTANTIATE_TEST_SUITE_P(
    All,
    HesaiCapture,
    ::testing::Values(Case{"hesai_40p", "hesai_40p_1673400149711850138.pcd", 56762, 0.3, 3},
                      Case{"hesai_64", "hesai_64_1673403880898440686.pcd", 93591, 0.3, 3},
                      Case{"hesai_qt64", "hesai_qt64_1673401196087570870.pcd", 34158, 0.1, 3},
                      Case{"hesai_qt128", "hesai_qt128_1730273789174759609.pcd", 73560, 0.3, 1},
                      Case{"hesai_xt16", "hesai_xt16_1732848128093928016.pcd", 26287, 0.05, 2},
                      Case{"hesai_xt32", "hesai_xt32_1673400678101968885.pcd", 63021, 0.05, 3}),
    [](const auto& param_info) { return param_info.param.model; });

}  // namespace
}  // namespace voqcal
