#pragma once

#include <optional>

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

/// How the frames of a capture begin.
enum class FrameLink {
  kEthernet,  ///< VLAN tags may follow.
  kCooked,    ///< Linux "any", version 1: 16 bytes.
  kCooked2,   ///< Linux "any", version 2: 20 bytes.
  kLoopback,  ///< BSD loopback: 4 bytes.
  kIp,        ///< No link header.
};

/// A datagram's payload, borrowed from its frame, and where it was sent.
struct UdpPayload {
  int port = 0;
  PacketBytes bytes;
};

/// A captured frame's IPv4 packet, if it has one.
std::optional<PacketBytes> FindIp(FrameLink link, PacketBytes frame);

/// The UDP datagram of a captured frame; nothing if it holds none, is a fragment, or is no IPv4. A
/// payload that the capture cut short is what there is of it.
std::optional<UdpPayload> FindUdpPayload(FrameLink link, PacketBytes frame);

}  // namespace voqcal
