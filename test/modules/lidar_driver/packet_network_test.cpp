// The driver on a sensor's packets: from the network to LIDAR_POINTS.
#include <chrono>
#include <stdexcept>
#include <string>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "lidar_driver/lidar_driver_node.hpp"
#include "messaging/convert_points.hpp"
#include "modules/nodes/node_test.hpp"
#include "rig/listening_address.hpp"
#include "support/temporary_folder.hpp"
#include "support/vlp16_packet.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Pair;

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

class PacketNetworkTest : public ::testing::Test {
 protected:
  PacketNetworkTest() {
    rig_.lidar_driver.source = LidarDriverOptions::Source::kSensor;
    rig_.lidar_sensor.packets.split_azimuth_rad = 0.0;
  }

  Rig rig_ = test::TestRig();
  Bus bus_{"memq://"};
  test::Inbox<pointcloud2_t> clouds_{&bus_, rig_.channels.lidar_points};
};

TEST_F(PacketNetworkTest, HearsTheNetworkAndSaysWhenItIsSilent) {
  rig_.lidar_sensor.port = FreePort();
  LidarDriverNode node(rig_, &bus_);
  EXPECT_EQ(node.State(),
            "waiting for packets on 127.0.0.1:" + std::to_string(rig_.lidar_sensor.port) + ": " +
                AddressDoubt("127.0.0.1"));
  const Sender sender(rig_.lidar_sensor.port);
  sender.Send({1, 2, 3});
  // A few at a time: a default receive buffer holds about 80. The fifth of the next turn shows
  // that the turn before is whole.
  const auto packets = test::Vlp16Turns(75 + 5);
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
  EXPECT_EQ(FromMessage(clouds_.messages[0]).points.size(), 75U * 12 * 32);
  // The kernel's time of the first packet, which is after `before` was read.
  EXPECT_GE(clouds_.messages[0].utime,
            std::chrono::duration_cast<std::chrono::microseconds>(before).count());
}

TEST_F(PacketNetworkTest, NamesAnAddressThatIsNotOfThisHost) {
  rig_.lidar_sensor.address = "192.0.2.1";  // RFC 5737: of documentation, nobody's
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode node(rig_, &bus_); }),
              AllOf(HasSubstr("cannot receive on UDP 192.0.2.1:2368: "),
                    HasSubstr("no network card of this host")));
}

TEST_F(PacketNetworkTest, NamesAPortThatAnotherHas) {
  rig_.lidar_sensor.port = FreePort();
  const LidarDriverNode first(rig_, &bus_);
  EXPECT_THAT(test::ErrorOf([&] { LidarDriverNode second(rig_, &bus_); }),
              EndsWith("Address already in use"));
}

}  // namespace
}  // namespace voqcal
