#pragma once

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

// RoboSense's spinning lidars (user manuals, "MSOP" and "DIFOP"): data packets of 1248 bytes with
// twelve blocks of an azimuth and 32 channels, big-endian. Neighbouring blocks of the same azimuth
// are two returns of one firing; of the RS-LiDAR-16, whose blocks have two firings of 16, the state
// packet says whether they are two returns instead.
//
// Angles are those of RoboSense's angle file (CSV: elevation, azimuth in degrees, a line a
// channel), else those of the sensor's own state packets (DIFOP, port 7788), if they come by the
// same way. But for the RS-LiDAR-16 nothing can be decoded before one of them is there.

PacketDecoder MakeRobosense16(const LidarUnit& unit);
PacketDecoder MakeRobosense32(const LidarUnit& unit);
PacketDecoder MakeRobosenseHelios(const LidarUnit& unit);
PacketDecoder MakeRobosenseBpearl(const LidarUnit& unit);

}  // namespace voqcal
