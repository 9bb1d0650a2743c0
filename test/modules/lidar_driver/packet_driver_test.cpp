// The driver on a sensor's packets: from captures to LIDAR_POINTS.
#include <chrono>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/likelihood/lidar_bias.hpp"
#include "lidar_driver/lidar_driver_node.hpp"
#include "messaging/convert_points.hpp"
#include "modules/nodes/node_test.hpp"
#include "result/lidar_bias_yaml.hpp"
#include "support/pcap_file.hpp"
#include "support/spectrum_packet.hpp"
#include "support/temporary_folder.hpp"
#include "support/vlp16_packet.hpp"
#include "voqcal/raw_t.hpp"

namespace voqcal {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::SizeIs;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kCaptureUtime = 1700000000123456;

std::int64_t UtimeOf(std::size_t i) {
  return kCaptureUtime + std::llround(static_cast<double>(i) * test::kVlp16PacketUs);
}

class PacketDriverTest : public ::testing::Test {
 protected:
  PacketDriverTest() {
    rig_.lidar_driver.source = LidarDriverOptions::Source::kSensor;
    rig_.lidar_sensor.packets.split_azimuth_rad = 0.0;
    rig_.lidar_sensor.is_unpaced = true;
  }

  void Capture(const std::vector<test::Vlp16PacketWriter>& packets) {
    test::PcapFile file;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      file.Add(UtimeOf(i), test::UdpFrame{2368, packets[i].bytes}.Ethernet());
    }
    Capture(file);
  }
  void Capture(const test::PcapFile& file) {
    rig_.lidar_sensor.pcap = folder_.Write("capture.pcap", file.Bytes());
  }

  // Runs a driver to its source's end.
  test::Counters Run() {
    LidarDriverNode node(rig_, &bus_);
    while (!node.IsDone()) {
      node.Step();
      test::HandleAll(&bus_);
    }
    return node.counters();
  }

  PointCloud Cloud(std::size_t i) const { return FromMessage(clouds_.messages.at(i)); }

  test::TemporaryFolder folder_;
  Rig rig_ = test::TestRig();
  Bus bus_{"memq://"};
  test::Inbox<pointcloud2_t> clouds_{&bus_, rig_.channels.lidar_points};
  test::Inbox<raw_t> packets_{&bus_, rig_.channels.lidar_packets};
};

TEST_F(PacketDriverTest, ACaptureGivesItsSweepsAtItsOwnTimes) {
  Capture(test::Vlp16Turns(150));
  EXPECT_THAT(Run(), Contains(Pair("packets", 150)));
  ASSERT_THAT(clouds_.messages, SizeIs(2));
  EXPECT_EQ(clouds_.messages[0].utime, kCaptureUtime);
  EXPECT_NEAR(static_cast<double>(clouds_.messages[1].utime - UtimeOf(75)), 0, 2);
  const PointCloud cloud = Cloud(1);
  EXPECT_TRUE(cloud.has_ring && cloud.has_time && cloud.has_intensity);
  ASSERT_EQ(cloud.points.size(), 75U * 12 * 32);
  EXPECT_NEAR(cloud.points[7].position_m.norm(), 3.0, 1e-6);
  EXPECT_THAT(packets_.messages, SizeIs(0));
}

TEST_F(PacketDriverTest, ACaptureGivesTheSameBytesEachTime) {
  Capture(test::Vlp16Turns(160));
  Run();
  const auto first = clouds_.messages;
  clouds_.messages.clear();
  Run();
  ASSERT_EQ(clouds_.messages.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(clouds_.messages[i].utime, first[i].utime);
    EXPECT_EQ(clouds_.messages[i].data, first[i].data);
  }
}

TEST_F(PacketDriverTest, ACaptureIsReplayedNoFasterThanItWasRecorded) {
  rig_.lidar_sensor.is_unpaced = false;
  Capture(test::Vlp16Turns(3 * 75));
  const auto start = Clock::now();
  Run();
  EXPECT_THAT(clouds_.messages, SizeIs(3));
  // Three sweeps begin two turns of 99.5 ms apart.
  EXPECT_GE(Clock::now() - start, std::chrono::milliseconds(199));
}

// Were it waited for, this would take an hour.
TEST_F(PacketDriverTest, APauseWithinACaptureIsNotWaitedFor) {
  rig_.lidar_sensor.is_unpaced = false;
  constexpr std::int64_t kHourUs = 3600000000;  // after which the sensor's clock shows the same
  const auto packets = test::Vlp16Turns(150);
  test::PcapFile file;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    file.Add(UtimeOf(i) + (i < 75 ? 0 : kHourUs),
             test::UdpFrame{2368, packets[i].bytes}.Ethernet());
  }
  Capture(file);
  Run();
  ASSERT_THAT(clouds_.messages, SizeIs(2));
  EXPECT_NEAR(static_cast<double>(clouds_.messages[1].utime - (UtimeOf(75) + kHourUs)), 0, 2);
}

TEST_F(PacketDriverTest, CountsWhatIsNotTheSensors) {
  auto packets = test::Vlp16Turns(80);
  packets[3].bytes.resize(512);
  packets[4].bytes[1205] = 0x28;  // another Velodyne
  test::PcapFile file;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    file.Add(UtimeOf(i), test::UdpFrame{2368, packets[i].bytes}.Ethernet());
    if (i == 5) file.Add(UtimeOf(i), test::UdpFrame{8308, packets[i].bytes}.Ethernet());
    if (i == 6) file.Add(UtimeOf(i), std::vector<std::uint8_t>(60, 0));
  }
  Capture(file);
  const test::Counters counters = Run();
  EXPECT_THAT(counters, Contains(Pair("packets", 78)));
  EXPECT_THAT(counters, Contains(Pair("packets of a wrong size", 1)));
  EXPECT_THAT(counters, Contains(Pair("packets of another sensor", 1)));
  EXPECT_THAT(counters, Contains(Pair("packets to other ports", 1)));
  EXPECT_THAT(counters, Contains(Pair("frames without UDP", 1)));
}

TEST_F(PacketDriverTest, ACaptureThatIsCutOffGivesWhatIsThere) {
  test::PcapFile file;
  const auto packets = test::Vlp16Turns(76);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    file.Add(UtimeOf(i), test::UdpFrame{2368, packets[i].bytes}.Ethernet());
  }
  rig_.lidar_sensor.pcap =
      folder_.Write("cut.pcap", file.Bytes().substr(0, file.Bytes().size() - 100));
  EXPECT_THAT(Run(), Contains(Pair("damage that ends the capture", 1)));
  EXPECT_THAT(clouds_.messages, SizeIs(1));
}

TEST_F(PacketDriverTest, NamesACaptureThatIsNone) {
  rig_.lidar_sensor.pcap = folder_.Write("notes.pcap", "no capture at all, only words");
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }), HasSubstr("notes.pcap"));
  rig_.lidar_sensor.pcap = folder_.Write("drive.pcap.gz", "\x1F\x8B\x08...");
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }),
              HasSubstr("drive.pcap.gz: is compressed: unpack it first (gunzip)"));
  rig_.lidar_sensor.pcap = folder_.path() / "missing.pcap";
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }), HasSubstr("missing.pcap"));
}

TEST_F(PacketDriverTest, SaysThatACaptureIsOfAnotherSensorOrToAnotherPort) {
  test::PcapFile alien;
  const std::vector<std::uint8_t> bytes(1262, 0);
  for (std::size_t i = 0; i < 10; ++i) {
    alien.Add(UtimeOf(i), test::UdpFrame{2368, bytes}.Ethernet());
  }
  Capture(alien);
  EXPECT_THAT(test::ErrorOf([&] { Run(); }),
              HasSubstr("capture.pcap: no VLP-16 packet among 10 of 1262 bytes: another "
                        "sensor? 1262 bytes is what hesai_40p sends"));
  test::PcapFile elsewhere;
  elsewhere.Add(UtimeOf(0), test::UdpFrame{2369, test::Vlp16Turns(1)[0].bytes}.Ethernet());
  Capture(elsewhere);
  EXPECT_THAT(test::ErrorOf([&] { Run(); }),
              HasSubstr("no packet to the lidar's port, but 1 to port 2369"));
}

TEST_F(PacketDriverTest, NamesTheCalibrationThatIsWrong) {
  Capture(test::Vlp16Turns(75));
  rig_.lidar_sensor.calibration = folder_.Write("unit.yaml", "lasers: [1, 2]");
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }),
              HasSubstr("unit.yaml: lasers must be a list of 16, has 2 (expected: "
                        "velodyne_pointcloud's YAML)"));
  rig_.lidar_sensor.calibration.clear();
  rig_.lidar_sensor.packets.protocol = FindLidarProtocol("ouster");
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }),
              HasSubstr("ouster needs a calibration: the sensor's metadata, JSON"));
}

TEST_F(PacketDriverTest, PublishesThePacketsThemselvesIfAskedTo) {
  rig_.lidar_sensor.are_packets_published = true;
  const auto packets = test::Vlp16Turns(76);
  Capture(packets);
  Run();
  ASSERT_THAT(packets_.messages, SizeIs(76));
  EXPECT_EQ(packets_.messages[3].data, packets[3].bytes);
  EXPECT_EQ(packets_.messages[3].utime, UtimeOf(3));
}

TEST_F(PacketDriverTest, TakesOffsetsOffTheRanges) {
  rig_.lidar_sensor.packets.unit.distance_offset_m = 0.25;
  rig_.lidar_sensor.packets.unit.ring_offsets_m.assign(16, 0.0);
  rig_.lidar_sensor.packets.unit.ring_offsets_m[2] = -0.5;
  Capture(test::Vlp16Turns(75));
  Run();
  for (const LidarPoint& point : Cloud(0).points) {
    ASSERT_NEAR(point.position_m.norm(), point.ring == 2 ? 3.25 : 2.75, 1e-6);
  }
}

TEST_F(PacketDriverTest, TakesTheBiasOfAnEarlierResultOffTheRanges) {
  LidarBias bias;
  bias.common = {0.02, 0.001, true};
  bias.rings.assign(16, {0.0, 0.001, true});
  bias.rings[5].value_m = 0.01;
  rig_.lidar_sensor.bias_from = folder_.Write("extrinsic.yaml", LidarBiasYaml(bias));
  Capture(test::Vlp16Turns(75));
  Run();
  // The sensor's unit is 2 mm; coordinates are single precision.
  for (const LidarPoint& point : Cloud(0).points) {
    ASSERT_NEAR(point.position_m.norm(), point.ring == 5 ? 2.97 : 2.98, 1e-6);
  }
}

TEST_F(PacketDriverTest, ReadsASpectrumScanOnItsOwnPort) {
  rig_.lidar_sensor.packets.protocol = FindLidarProtocol("spectrum_scan");
  test::PcapFile file;
  // Three packets of 20 degrees each make a scan; the fourth begins anew at 60 degrees.
  for (int i = 0; i < 6; ++i) {
    std::vector<test::SpectrumPoint> points(160);
    for (int j = 0; j < 160; ++j) {
      points[j].theta_deg = 60.0 + 20.0 * (i % 3 + j / 160.0);
      points[j].distance_mm = 4000;
    }
    const auto base_us = static_cast<std::uint32_t>(1000 * i);
    file.Add(kCaptureUtime + 1000 * i,
             test::UdpFrame{5044, test::SpectrumVersionOne(base_us, 100, points)}.Ethernet());
  }
  Capture(file);
  EXPECT_THAT(Run(), Contains(Pair("packets", 6)));
  ASSERT_THAT(clouds_.messages, SizeIs(2));
  const PointCloud cloud = Cloud(0);
  ASSERT_EQ(cloud.points.size(), 3U * 160);
  EXPECT_FALSE(cloud.has_ring);
  EXPECT_NEAR(cloud.points[0].position_m.norm(), 4.0, 1e-6);
}

}  // namespace
}  // namespace voqcal
