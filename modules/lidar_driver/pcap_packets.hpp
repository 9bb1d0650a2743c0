#pragma once

#include <filesystem>
#include <memory>

#include "lidar_driver/packet_source.hpp"

namespace voqcal {

/// The datagrams to `port` (0: to any) of a capture (pcap or pcapng, by libpcap), with the times of
/// the capture. A capture that is cut off or damaged ends there, with a warning and a count.
/// @throws std::runtime_error naming the file and the cause.
std::unique_ptr<PacketSource> MakePcapPackets(const std::filesystem::path& path, int port);

}  // namespace voqcal
