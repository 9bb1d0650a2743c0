#pragma once

#include <memory>
#include <string>

#include "lidar_driver/packet_source.hpp"

namespace voqcal {

/// The datagrams that arrive at an IPv4 address and port of this host, with the kernel's times of
/// arrival. Next waits up to 50 ms.
/// @throws std::runtime_error naming address, port and cause (not an address of this host, ...).
std::unique_ptr<PacketSource> MakeUdpPackets(const std::string& address, int port);

}  // namespace voqcal
