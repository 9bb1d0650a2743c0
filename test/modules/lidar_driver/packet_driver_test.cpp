// The driver on a sensor's packets: from captures and from the network to LIDAR_POINTS.
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/estimation/lidar_bias.hpp"
#include "lidar_driver/lidar_driver_node.hpp"
#include "messaging/convert_points.hpp"
#include "modules/nodes/node_test.hpp"
#include "rig/lidar_bias_yaml.hpp"
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
constexpr double kPacketUs = 12 * 110.592;

// Turns of 75 packets, each beam with an echo at 3 m.
std::vector<test::Vlp16PacketWriter> Turns(int num_packets) {
  constexpr int kStep = 40;
  std::vector<test::Vlp16PacketWriter> packets;
  for (int i = 0; i < num_packets; ++i) {
    packets.emplace_back(i * 12 * kStep % 36000,
                         kStep,
                         static_cast<std::uint32_t>(1000 + std::llround(i * kPacketUs)));
    packets.back().SetAllEchoes(1500, 50);
  }
  return packets;
}

std::int64_t UtimeOf(std::size_t i) {
  return kCaptureUtime + std::llround(static_cast<double>(i) * kPacketUs);
}

class PacketDriverTest : public ::testing::Test {
 protected:
  PacketDriverTest() {
    rig_.lidar_driver.source = DriverSource::kVlp16;
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
  Capture(Turns(150));
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
  Capture(Turns(160));
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
  Capture(Turns(3 * 75));
  const auto start = Clock::now();
  Run();
  EXPECT_THAT(clouds_.messages, SizeIs(3));
  // Three sweeps begin two turns of 99.5 ms apart.
  EXPECT_GE(Clock::now() - start, std::chrono::milliseconds(199));
}

TEST_F(PacketDriverTest, CountsWhatIsNotTheSensors) {
  auto packets = Turns(80);
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
  const auto packets = Turns(76);
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
  rig_.lidar_sensor.pcap = folder_.path() / "missing.pcap";
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }), HasSubstr("missing.pcap"));
}

TEST_F(PacketDriverTest, PublishesThePacketsThemselvesIfAskedTo) {
  rig_.lidar_sensor.are_packets_published = true;
  const auto packets = Turns(76);
  Capture(packets);
  Run();
  ASSERT_THAT(packets_.messages, SizeIs(76));
  EXPECT_EQ(packets_.messages[3].data, packets[3].bytes);
  EXPECT_EQ(packets_.messages[3].utime, UtimeOf(3));
}

TEST_F(PacketDriverTest, TakesOffsetsOffTheRanges) {
  rig_.lidar_sensor.packets.vlp16.distance_offset_m = 0.25;
  rig_.lidar_sensor.packets.vlp16.ring_offsets_m.assign(16, 0.0);
  rig_.lidar_sensor.packets.vlp16.ring_offsets_m[2] = -0.5;
  Capture(Turns(75));
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
  Capture(Turns(75));
  Run();
  // The sensor's unit is 2 mm; coordinates are single precision.
  for (const LidarPoint& point : Cloud(0).points) {
    ASSERT_NEAR(point.position_m.norm(), point.ring == 5 ? 2.97 : 2.98, 1e-6);
  }
}

TEST_F(PacketDriverTest, ReadsASpectrumScanOnItsOwnPort) {
  rig_.lidar_driver.source = DriverSource::kSpectrumScan;
  rig_.lidar_sensor.packets.model = LidarModel::kSpectrumScan;
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

// Sends from this host to itself.
class Sender {
 public:
  explicit Sender(int port) : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(static_cast<std::uint16_t>(port));
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  ~Sender() { close(socket_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void Send(const std::vector<std::uint8_t>& bytes) const {
    const ssize_t num_sent = sendto(socket_,
                                    bytes.data(),
                                    bytes.size(),
                                    0,
                                    reinterpret_cast<const sockaddr*>(&to_),
                                    sizeof(to_));
    ASSERT_EQ(num_sent, static_cast<ssize_t>(bytes.size()));
  }

 private:
  int socket_;
  sockaddr_in to_{};
};

// A port that nothing listens on now.
int FreePort() {
  const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in local{};
  local.sin_family = AF_INET;
  local.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(local);
  const bool is_bound = bind(descriptor, reinterpret_cast<sockaddr*>(&local), size) == 0 &&
                        getsockname(descriptor, reinterpret_cast<sockaddr*>(&local), &size) == 0;
  close(descriptor);
  if (!is_bound) throw std::runtime_error("no free UDP port");
  return ntohs(local.sin_port);
}

TEST_F(PacketDriverTest, HearsTheNetworkAndSaysWhenItIsSilent) {
  rig_.lidar_sensor.port = FreePort();
  LidarDriverNode node(rig_, &bus_);
  EXPECT_EQ(node.State(),
            "waiting for packets on 127.0.0.1:" + std::to_string(rig_.lidar_sensor.port));
  const Sender sender(rig_.lidar_sensor.port);
  sender.Send({1, 2, 3});
  // A few at a time: a default receive buffer holds about 80. The fifth of the next turn shows
  // that the turn before is whole.
  const auto packets = Turns(75 + 5);
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  for (std::size_t i = 0; i < packets.size(); ++i) {
    sender.Send(packets[i].bytes);
    if (i % 10 == 9) node.Step();
  }
  while (clouds_.messages.empty()) {
    node.Step();
    test::HandleAll(&bus_);
  }
  EXPECT_FALSE(node.IsDone());
  EXPECT_EQ(node.State(), "running");
  EXPECT_THAT(node.counters(), Contains(Pair("packets of a wrong size", 1)));
  EXPECT_EQ(Cloud(0).points.size(), 75U * 12 * 32);
  // The kernel's time of the first packet, which is after `before` was read.
  EXPECT_GE(clouds_.messages[0].utime,
            std::chrono::duration_cast<std::chrono::microseconds>(before).count());
}

TEST_F(PacketDriverTest, NamesAnAddressThatIsNotOfThisHost) {
  rig_.lidar_sensor.address = "192.0.2.1";  // RFC 5737: of documentation, nobody's
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }),
              HasSubstr("cannot receive on UDP 192.0.2.1:2368"));
}

}  // namespace
}  // namespace voqcal
