#include "lidar_driver/udp_frame.hpp"

#include <gtest/gtest.h>

#include "support/pcap_file.hpp"

namespace voqcal {
namespace {

using Bytes = std::vector<std::uint8_t>;

const test::UdpFrame kFrame{2368, {1, 2, 3}};

// The payload that is found, and nothing if there is none or its port is another.
std::optional<Bytes> Found(FrameLink link, const Bytes& frame) {
  const auto payload = FindUdpPayload(link, {frame.data(), frame.size()});
  if (!payload || payload->port != 2368) return std::nullopt;
  return Bytes(payload->bytes.data, payload->bytes.data + payload->bytes.size);
}

TEST(FindUdpPayload, UnderstandsEveryLinkLayerThatCapturesHave) {
  Bytes tagged(12, 0xAA);
  for (const int byte : {0x88, 0xA8, 0, 1, 0x81, 0x00, 0, 2, 0x08, 0x00}) {
    tagged.push_back(static_cast<std::uint8_t>(byte));
  }
  Bytes cooked(16, 0);
  cooked[14] = 0x08;
  Bytes cooked2(20, 0);
  cooked2[0] = 0x08;
  EXPECT_EQ(Found(FrameLink::kEthernet, kFrame.Ethernet()), kFrame.payload);
  EXPECT_EQ(Found(FrameLink::kEthernet, kFrame.After(tagged)), kFrame.payload);
  EXPECT_EQ(Found(FrameLink::kCooked, kFrame.After(cooked)), kFrame.payload);
  EXPECT_EQ(Found(FrameLink::kCooked2, kFrame.After(cooked2)), kFrame.payload);
  EXPECT_EQ(Found(FrameLink::kLoopback, kFrame.After({2, 0, 0, 0})), kFrame.payload);
  EXPECT_EQ(Found(FrameLink::kIp, kFrame.Ip()), kFrame.payload);
}

TEST(FindUdpPayload, LeavesPaddingAndKnowsACutPayload) {
  Bytes padded = kFrame.Ethernet();
  padded.resize(60, 0);
  EXPECT_EQ(Found(FrameLink::kEthernet, padded), kFrame.payload);
  Bytes cut = kFrame.Ethernet();
  cut.pop_back();
  EXPECT_EQ(Found(FrameLink::kEthernet, cut), (Bytes{1, 2}));
}

TEST(FindUdpPayload, FindsNothingInOtherFrames) {
  const Bytes frame = kFrame.Ip();
  for (std::size_t size = 0; size < 28; ++size) {
    EXPECT_FALSE(Found(FrameLink::kIp, Bytes(frame.begin(), frame.begin() + size))) << size;
  }
  const auto with = [&frame](std::size_t at, std::uint8_t value) {
    Bytes changed = frame;
    changed[at] = value;
    return changed;
  };
  EXPECT_FALSE(Found(FrameLink::kIp, with(0, 0x65)));  // version 6
  EXPECT_FALSE(Found(FrameLink::kIp, with(0, 0x44)));  // a header shorter than can be
  EXPECT_FALSE(Found(FrameLink::kIp, with(0, 0x4F)));  // longer than the frame
  EXPECT_FALSE(Found(FrameLink::kIp, with(9, 6)));     // TCP
  EXPECT_FALSE(Found(FrameLink::kIp, with(25, 7)));    // shorter than UDP's own header
  EXPECT_FALSE(Found(FrameLink::kIp, test::UdpFrame{2368, {1}, 0x2000}.Ip()));  // first fragment
  EXPECT_FALSE(Found(FrameLink::kIp, test::UdpFrame{2368, {1}, 0x0010}.Ip()));  // a later one
  EXPECT_FALSE(Found(FrameLink::kEthernet, Bytes(14, 0)));
}

}  // namespace
}  // namespace voqcal
