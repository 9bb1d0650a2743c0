#pragma once

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

// Velodyne's lidars speak one language (VLP-16 User Manual 63-9243, VLP-32C 63-9325, VLS-128
// 63-9483, HDL-32E 63-9113, HDL-64E 63-HDL64ES3): 1206 bytes, twelve blocks of flag, azimuth and 32
// lasers. They differ in the lasers' angles, in when they fire, and in the unit of distance.
//
// A unit's calibration is the YAML file of ROS' velodyne_pointcloud ("lasers", each with laser_id,
// rot_correction and vert_correction in radians, dist_correction, vert_offset_correction,
// horiz_offset_correction in metres). The HDL-64E's two-point corrections and its corrections of
// intensity are not applied.

constexpr std::int64_t kVelodyneClockUs = 3600000000;  ///< They count within the hour.

PacketDecoder MakeVelodyneVlp16(const LidarUnit& unit);
PacketDecoder MakeVelodyneVlp16HiRes(const LidarUnit& unit);
PacketDecoder MakeVelodyneVlp32c(const LidarUnit& unit);
PacketDecoder MakeVelodyneVls128(const LidarUnit& unit);
PacketDecoder MakeVelodyneHdl32e(const LidarUnit& unit);
PacketDecoder MakeVelodyneHdl64e(const LidarUnit& unit);  ///< Single return mode only.

}  // namespace voqcal
