#include "lidar_driver/udp_frame.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace voqcal {
namespace {

constexpr int kTypeIp4 = 0x0800;

int ReadBig16(const std::uint8_t* bytes) { return bytes[0] << 8 | bytes[1]; }

PacketBytes After(PacketBytes bytes, std::size_t num_bytes) {
  return {bytes.data + num_bytes, bytes.size - num_bytes};
}

// What follows an Ethernet header and its VLAN tags (IEEE 802.1Q), if it is IPv4.
std::optional<PacketBytes> AfterEthernet(PacketBytes frame) {
  constexpr std::size_t kAddresses = 12;
  constexpr int kTypeVlan = 0x8100;
  constexpr int kTypeServiceVlan = 0x88A8;
  constexpr std::size_t kVlanTag = 4;
  if (frame.size < kAddresses) return std::nullopt;
  PacketBytes rest = After(frame, kAddresses);
  while (rest.size >= 2) {
    const int type = ReadBig16(rest.data);
    if (type == kTypeIp4) return After(rest, 2);
    const bool is_tag = type == kTypeVlan || type == kTypeServiceVlan;
    if (!is_tag || rest.size < kVlanTag) return std::nullopt;
    rest = After(rest, kVlanTag);
  }
  return std::nullopt;
}

// What follows a header of fixed size whose 16 bits at `type_at` name the protocol.
std::optional<PacketBytes> AfterCooked(PacketBytes frame, std::size_t type_at, std::size_t size) {
  if (frame.size < size || ReadBig16(frame.data + type_at) != kTypeIp4) return std::nullopt;
  return After(frame, size);
}

}  // namespace

std::optional<PacketBytes> FindIp(FrameLink link, PacketBytes frame) {
  constexpr std::size_t kLoopbackHeader = 4;
  switch (link) {
    case FrameLink::kEthernet:
      return AfterEthernet(frame);
    case FrameLink::kCooked:
      return AfterCooked(frame, 14, 16);
    case FrameLink::kCooked2:
      return AfterCooked(frame, 0, 20);
    case FrameLink::kLoopback:
      if (frame.size < kLoopbackHeader) return std::nullopt;
      return After(frame, kLoopbackHeader);
    case FrameLink::kIp:
      return frame;
  }
  return std::nullopt;
}

std::optional<UdpPayload> FindUdpPayload(FrameLink link, PacketBytes frame) {
  constexpr std::size_t kMinIpHeader = 20;
  constexpr std::size_t kUdpHeader = 8;
  constexpr int kProtocolUdp = 17;
  constexpr int kFragmentMask = 0x3FFF;  // "more fragments" and the offset
  const auto ip = FindIp(link, frame);
  if (!ip || ip->size < kMinIpHeader) return std::nullopt;
  const std::size_t ip_header = std::size_t{4} * (ip->data[0] & 0x0F);
  const bool is_whole_udp = ip->data[0] >> 4 == 4 && ip->data[9] == kProtocolUdp &&
                            (ReadBig16(ip->data + 6) & kFragmentMask) == 0;
  if (!is_whole_udp || ip_header < kMinIpHeader || ip->size < ip_header + kUdpHeader) {
    return std::nullopt;
  }
  const PacketBytes udp = After(*ip, ip_header);
  const auto udp_size = static_cast<std::size_t>(ReadBig16(udp.data + 4));
  if (udp_size < kUdpHeader) return std::nullopt;
  // Short Ethernet frames are padded: the header tells where the payload ends.
  const std::size_t num_there = std::min(udp_size, udp.size);
  return UdpPayload{ReadBig16(udp.data + 2), {udp.data + kUdpHeader, num_there - kUdpHeader}};
}

}  // namespace voqcal
