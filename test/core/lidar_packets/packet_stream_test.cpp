#include "core/lidar_packets/packet_stream.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/lidar_packets/velodyne.hpp"
#include "support/spectrum_packet.hpp"
#include "support/vlp16_packet.hpp"

namespace voqcal {
namespace {

using test::Vlp16PacketWriter;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kHostUtime = 1700000000000000;
constexpr int kStep = 40;  // centidegrees a block: 75 packets a turn
constexpr double kPacketUs = 12 * 110.592;

// Packets of a lidar that turns steadily, each beam with an echo.
std::vector<Vlp16PacketWriter> Turns(int num_packets, std::uint32_t first_us = 1000) {
  std::vector<Vlp16PacketWriter> packets;
  for (int i = 0; i < num_packets; ++i) {
    const auto time_us = static_cast<std::uint32_t>((first_us + std::llround(i * kPacketUs)) %
                                                    std::int64_t{kVelodyneClockUs});
    packets.emplace_back(i * 12 * kStep % 36000, kStep, time_us);
    packets.back().SetAllEchoes(1500, 50);
  }
  return packets;
}

std::vector<TimedSweep> SweepsOf(const std::vector<Vlp16PacketWriter>& packets,
                                 LidarPacketStream* stream) {
  std::vector<TimedSweep> sweeps;
  const auto append = [&sweeps](std::vector<TimedSweep> more) {
    for (TimedSweep& sweep : more) sweeps.push_back(std::move(sweep));
  };
  for (std::size_t i = 0; i < packets.size(); ++i) {
    append(stream->Add(packets[i].Bytes(),
                       kHostUtime + std::llround(static_cast<double>(i) * kPacketUs)));
  }
  append(stream->Finish());
  return sweeps;
}

LidarPacketOptions SplitAt(double split_deg) {
  LidarPacketOptions options;
  options.split_azimuth_rad = split_deg * M_PI / 180.0;
  return options;
}

TEST(LidarPacketStream, EndsSweepsAtAnyAzimuth) {
  for (const double split_deg : {0.0, 0.1, 123.4, 359.9}) {
    LidarPacketStream stream(SplitAt(split_deg));
    const auto sweeps = SweepsOf(Turns(75 * 3), &stream);
    ASSERT_EQ(sweeps.size(), split_deg == 0.0 ? 3U : 4U);
    for (std::size_t i = 1; i + 1 < sweeps.size(); ++i) {
      EXPECT_EQ(sweeps[i].returns.size(), 75U * 12 * 32) << split_deg;
      // Lasers lie 0.008 degrees apart.
      EXPECT_NEAR(sweeps[i].returns[0].azimuth_rad * 180 / M_PI, split_deg, 0.01);
      // utime is in whole microseconds, and the packets' own times are rounded to them.
      EXPECT_GE(sweeps[i].returns[0].point.time_s, 0.0F);
      EXPECT_LT(sweeps[i].returns[0].point.time_s, 1e-6F);
      // A turn after the first, but for the pause of 20.7 us after a firing's last laser.
      EXPECT_NEAR(sweeps[i].returns.back().point.time_s, 75 * kPacketUs * 1e-6, 23e-6);
      EXPECT_NEAR(static_cast<double>(sweeps[i].utime - sweeps[i - 1].utime),
                  i == 1 ? split_deg / 360 * 75 * kPacketUs + (split_deg == 0) * 75 * kPacketUs
                         : 75 * kPacketUs,
                  5.0);
    }
  }
}

TEST(LidarPacketStream, SortsPacketsThatOvertookEachOther) {
  const auto packets = Turns(160);
  LidarPacketStream ordered(SplitAt(90));
  const auto expected = SweepsOf(packets, &ordered);
  auto shuffled = packets;
  for (std::size_t i = 4; i + 4 < shuffled.size(); i += 4) {
    std::reverse(shuffled.begin() + i, shuffled.begin() + i + 4);
  }
  LidarPacketStream stream(SplitAt(90));
  const auto sweeps = SweepsOf(shuffled, &stream);
  ASSERT_EQ(sweeps.size(), expected.size());
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    EXPECT_EQ(sweeps[i].utime, expected[i].utime);
    ASSERT_EQ(sweeps[i].returns.size(), expected[i].returns.size());
    for (std::size_t j = 0; j < sweeps[i].returns.size(); ++j) {
      ASSERT_EQ(sweeps[i].returns[j].azimuth_rad, expected[i].returns[j].azimuth_rad);
      ASSERT_EQ(sweeps[i].returns[j].point.time_s, expected[i].returns[j].point.time_s);
    }
  }
  EXPECT_EQ(stream.Counts().count("packets late"), 0U);
}

TEST(LidarPacketStream, CountsLostLateAndAlienPackets) {
  auto packets = Turns(150);
  const Vlp16PacketWriter late = packets[20];
  packets.erase(packets.begin() + 20, packets.begin() + 23);
  packets.insert(packets.begin() + 60, late);
  packets[5].bytes[1205] = 0;
  packets[6].bytes.resize(100);
  LidarPacketStream stream(SplitAt(0));
  const auto sweeps = SweepsOf(packets, &stream);
  EXPECT_EQ(sweeps.size(), 2U);
  EXPECT_EQ(stream.Counts().at("packets"), 145);
  EXPECT_EQ(stream.Counts().at("packets late"), 1);
  EXPECT_EQ(stream.Counts().at("packets lost"), 5);  // three, and the two at fault
  EXPECT_EQ(stream.Counts().at("packets of another sensor"), 1);
  EXPECT_EQ(stream.Counts().at("packets of a wrong size"), 1);
}

TEST(LidarPacketStream, ATurnThatIsLostDoesNotJoinTwoSweeps) {
  auto packets = Turns(75 * 4);
  packets.erase(packets.begin() + 100, packets.begin() + 100 + 75);  // from and to 120 degrees
  LidarPacketStream stream(SplitAt(0));
  const auto sweeps = SweepsOf(packets, &stream);
  for (const TimedSweep& sweep : sweeps) {
    EXPECT_LT(sweep.returns.back().point.time_s, 0.11F);
  }
}

TEST(LidarPacketStream, FollowsTheHourAndTheHost) {
  // The clock wraps within the first turn; utime goes on.
  LidarPacketStream stream(SplitAt(0));
  const auto sweeps = SweepsOf(Turns(150, kVelodyneClockUs - 50000), &stream);
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_EQ(sweeps[0].utime, kHostUtime);
  EXPECT_NEAR(static_cast<double>(sweeps[1].utime - sweeps[0].utime), 75 * kPacketUs, 2.0);
}

TEST(LidarPacketStream, TrustsASynchronisedSensor) {
  // 3 ms before the host's time within the hour: sent, and on its way for 3 ms.
  const auto in_hour_us =
      static_cast<std::uint32_t>((kHostUtime - 3000) % std::int64_t{kVelodyneClockUs});
  LidarPacketStream stream(SplitAt(0));
  EXPECT_EQ(SweepsOf(Turns(10, in_hour_us), &stream).at(0).utime, kHostUtime - 3000);
}

TEST(LidarPacketStream, KeepsTheReturnsThatAreAskedFor) {
  // In dual mode even blocks hold the last return. Beam 0: last 10 m, strongest 3 m. Beam 1: the
  // last is the strongest, 5 m; the other is the second strongest, 2 m. Beam 2: both the same.
  Vlp16PacketWriter packet(0, kStep, 1000, 0x39);
  packet.SetEcho(0, 0, 0, 5000, 20);
  packet.SetEcho(1, 0, 0, 1500, 90);
  packet.SetEcho(0, 0, 1, 2500, 80);
  packet.SetEcho(1, 0, 1, 1000, 30);
  packet.SetEcho(0, 0, 2, 2000, 50);
  packet.SetEcho(1, 0, 2, 2000, 50);
  const auto distances_m = [&packet](ReturnChoice returns) {
    LidarPacketOptions options = SplitAt(0);
    options.returns = returns;
    LidarPacketStream stream(options);
    std::vector<double> found_m;
    for (const TimedSweep& sweep : SweepsOf({packet}, &stream)) {
      for (const PacketReturn& echo : sweep.returns) found_m.push_back(echo.distance_m);
    }
    return found_m;
  };
  EXPECT_EQ(distances_m(ReturnChoice::kBoth), (std::vector<double>{3, 10, 2, 5, 4}));
  EXPECT_EQ(distances_m(ReturnChoice::kStrongest), (std::vector<double>{3, 5, 4}));
  EXPECT_EQ(distances_m(ReturnChoice::kLast), (std::vector<double>{10, 5, 4}));
}

TEST(LidarPacketStream, GoesOnAfterASensorIsSwitchedOffAndOn) {
  // Its clock begins anew, ten minutes back by its own count and a minute on by the host's.
  LidarPacketStream stream(SplitAt(0));
  std::vector<TimedSweep> sweeps;
  const auto append = [&](std::uint32_t first_us, std::int64_t host_utime) {
    for (int i = 0; i < 160; ++i) {
      const auto after_us = static_cast<std::uint32_t>(std::llround(i * kPacketUs));
      Vlp16PacketWriter packet(i * 12 * kStep % 36000, kStep, first_us + after_us);
      packet.SetAllEchoes(1500, 50);
      for (auto& sweep : stream.Add(packet.Bytes(), host_utime + after_us)) sweeps.push_back(sweep);
    }
  };
  append(600000000, kHostUtime);
  append(1000, kHostUtime + 60000000);
  // Of each run two whole turns, and of the first what was left of the third.
  ASSERT_EQ(sweeps.size(), 5U);
  EXPECT_EQ(sweeps[0].utime, kHostUtime);
  EXPECT_EQ(sweeps[3].utime, kHostUtime + 60000000);
  EXPECT_EQ(stream.Counts().at("clock restarts"), 1);
  EXPECT_EQ(stream.Counts().count("packets late"), 0U);
  EXPECT_EQ(stream.Counts().count("packets lost"), 0U);
}

TEST(LidarPacketStream, LeavesOutSecondCopies) {
  const auto packets = Turns(150);
  std::vector<Vlp16PacketWriter> twice;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    twice.push_back(packets[i]);
    if (i >= 3) twice.push_back(packets[i - 3]);  // a mirrored port may be late
  }
  LidarPacketStream once(SplitAt(0));
  LidarPacketStream stream(SplitAt(0));
  const auto expected = SweepsOf(packets, &once);
  std::vector<TimedSweep> sweeps;
  for (std::size_t i = 0; i < twice.size(); ++i) {
    const auto host_utime = kHostUtime + std::llround(static_cast<double>(i) / 2 * kPacketUs);
    for (auto& sweep : stream.Add(twice[i].Bytes(), host_utime)) sweeps.push_back(sweep);
  }
  for (auto& sweep : stream.Finish()) sweeps.push_back(sweep);
  EXPECT_EQ(stream.Counts().at("packets twice"), 147);
  EXPECT_EQ(stream.Counts().at("packets"), 150);
  ASSERT_EQ(sweeps.size(), expected.size());
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    EXPECT_EQ(sweeps[i].returns.size(), expected[i].returns.size());
  }
}

TEST(LidarPacketStream, TakesTheHostsTimeWhereTheSensorsStandsStill) {
  auto packets = Turns(150);
  for (Vlp16PacketWriter& packet : packets) {
    std::fill(packet.bytes.begin() + 1200, packet.bytes.begin() + 1204, std::uint8_t{5});
  }
  LidarPacketStream stream(SplitAt(0));
  const auto sweeps = SweepsOf(packets, &stream);
  ASSERT_EQ(sweeps.size(), 2U);
  EXPECT_EQ(sweeps[0].returns.size(), 75U * 12 * 32);
  EXPECT_NEAR(static_cast<double>(sweeps[1].utime - sweeps[0].utime), 75 * kPacketUs, 2.0);
  EXPECT_EQ(stream.Counts().at("packets whose clock stood still"), 149);
  EXPECT_EQ(stream.Counts().count("clock restarts"), 0U);
}

TEST(LidarPacketStream, SaysWhoMayHaveSentWhatItDoesNotKnow) {
  LidarPacketStream stream(SplitAt(0));
  const std::vector<std::uint8_t> bytes(1448, 0);
  for (int i = 0; i < 12; ++i) stream.Add({bytes.data(), bytes.size()}, kHostUtime + i);
  EXPECT_EQ(stream.WrongLidar(),
            "no VLP-16 packet among 12 of 1448 bytes: another sensor? 1448 bytes is what "
            "baraja_spectrum_scan sends");
  stream.Add(Turns(1)[0].Bytes(), kHostUtime);
  EXPECT_EQ(stream.WrongLidar(), "");
}

TEST(LidarPacketStream, IsNotLedAstrayByAPacketWithoutPoints) {
  LidarPacketOptions options;
  options.protocol = FindLidarProtocol("spectrum_scan");
  LidarPacketStream stream(options);
  const test::SpectrumPoint point{0, 40.0, -5.0, 1000, 50};
  for (int i = 0; i < 20; ++i) {
    const bool is_empty = i == 10;
    const auto bytes = test::SpectrumVersionZero(
        5000000 + 1000 * i, is_empty ? std::vector<test::SpectrumPoint>() : std::vector{point});
    stream.Add({bytes.data(), bytes.size()}, kHostUtime + 1000 * i);
  }
  EXPECT_EQ(stream.Counts().at("packets"), 19);
  EXPECT_EQ(stream.Counts().at("packets without points"), 1);
  EXPECT_EQ(stream.Counts().count("clock restarts"), 0U);
}

TEST(LidarPacketStream, TakesOffWhatReadsLong) {
  Vlp16PacketWriter packet(0, kStep, 1000);
  packet.SetEcho(0, 0, 1, 1000, 1);  // ring 8
  LidarPacketOptions options;
  options.unit.distance_offset_m = 0.02;
  options.unit.ring_offsets_m.assign(16, 0.0);
  options.unit.ring_offsets_m[8] = -0.005;
  LidarPacketStream stream(options);
  const PacketReturn echo = SweepsOf({packet}, &stream).at(0).returns.at(0);
  EXPECT_NEAR(echo.point.position_m.norm(), 2.0 - 0.015, 1e-6);
  EXPECT_EQ(echo.distance_m, 2.0);  // as measured
}

TEST(LidarPacketOptionsProblems, NamesTheRuleAndTheValue) {
  LidarPacketOptions options;
  options.unit.elevations_rad.assign(3, 0.0);
  options.unit.ring_offsets_m.assign(17, 0.0);
  EXPECT_THAT(options.Problems(),
              ElementsAre("elevations_deg must have 16 entries or none for velodyne_vlp16, is 3",
                          "ring_offsets_m must have 16 entries or none for velodyne_vlp16, is 17"));
  options.unit = {};
  options.unit.elevations_rad.assign(16, 2.0);
  EXPECT_THAT(options.Problems()[0], HasSubstr("within -90 and 90, is 114.59"));
}

TEST(LidarPacketStream, RefusesBadOptions) {
  EXPECT_THROW(LidarPacketStream(SplitAt(360)), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
