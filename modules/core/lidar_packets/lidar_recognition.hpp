#pragma once

#include <string>
#include <vector>

#include "core/lidar_packets/lidar_protocols.hpp"

namespace voqcal {

/// The lidars of the table whose decoder takes this datagram as one of its own with points. Models
/// of one decoder count once. Empty: none, or one that is known by its calibration alone.
/// @param calibration  what the vendor's file says, or empty; a lidar that it is not for is left
/// out.
std::vector<const LidarProtocol*> LidarsThatSend(PacketBytes datagram,
                                                 const std::string& calibration);

}  // namespace voqcal
