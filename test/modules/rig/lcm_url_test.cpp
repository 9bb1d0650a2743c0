#include "rig/lcm_url.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::HasSubstr;

// What lcm_create of LCM 1.3.1 takes, or would with a route or a broker.
TEST(LcmUrlProblem, IsNoneForWhatLcmTakes) {
  for (const char* url : {"udpm://",
                          "udpm://?ttl=1",
                          "udpm://239.255.76.67",
                          "udpm://239.255.76.67:7667",
                          "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304",
                          "udpm://224.0.0.1:65535?transmit_only=true",
                          "tcpq://",
                          "tcpq://localhost",
                          "tcpq://broker.lan:7700",
                          "memq://",
                          "file:///tmp/raw.lcm?speed=0"}) {
    EXPECT_EQ(LcmUrlProblem(url), "") << url;
  }
}

TEST(LcmUrlProblem, NamesTheSchemesThatThereAre) {
  for (const char* url : {"", "http://x", "udpm:239.255.76.67:7667", "239.255.76.67:7667"}) {
    EXPECT_THAT(LcmUrlProblem(url), HasSubstr("begin with udpm://, tcpq://")) << url;
  }
}

TEST(LcmUrlProblem, WantsAMulticastAddress) {
  for (const char* url :
       {"udpm://10.0.0.1:7667", "udpm://rig:7667", "udpm://:7667", "udpm://239.255.76:7667"}) {
    EXPECT_THAT(LcmUrlProblem(url), HasSubstr("multicast address")) << url;
  }
}

TEST(LcmUrlProblem, WantsAPort) {
  for (const char* url : {"udpm://239.255.76.67:",
                          "udpm://239.255.76.67:0",
                          "tcpq://localhost:x",
                          "udpm://239.255.76.67:65536",
                          "udpm://239.255.76.67:7667:1"}) {
    EXPECT_THAT(LcmUrlProblem(url), HasSubstr("port of 1 to 65535")) << url;
  }
}

// LCM says no more than a warning to these, and messages get lost or leave the host.
TEST(LcmUrlProblem, WantsOptionsThatLcmKnows) {
  const std::string network = "udpm://239.255.76.67:7667?";
  EXPECT_THAT(LcmUrlProblem(network + "rcv_buf_size=1"), HasSubstr("\"rcv_buf_size\""));
  EXPECT_THAT(LcmUrlProblem(network + "recv_buf_size=4M"), HasSubstr("recv_buf_size"));
  EXPECT_THAT(LcmUrlProblem(network + "ttl=1&recv_buf_size"), HasSubstr("recv_buf_size"));
  EXPECT_THAT(LcmUrlProblem(network + "ttl=256"), HasSubstr("ttl of 0 to 255"));
}

}  // namespace
}  // namespace voqcal
