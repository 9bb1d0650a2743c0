#pragma once

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

/// Decodes a packet of a Baraja Spectrum-Scan, of either version. Multi-byte fields are big-endian.
///
/// Version 1, 1448 bytes: 0x01; base time u32 us; cycle time u16; alarm u8; then 160 points of 9
/// bytes: time u8 (of 8 * cycle / 1000 us after the base, counted on past 256), theta u16 0.01 deg,
/// then bit by bit phi 15 (signed, 0.01 deg), distance 19 (mm; all ones: none), intensity 8, head
/// 4, return number 1, spare 1.
/// Version 0: 0x44 0x50; 16 bytes of header, with the number of points u16 at byte 14; then points
/// of 20 bytes: time u32 us, theta and phi i32 (1e-4 deg), distance u32 mm (0: none), intensity u8,
/// head u8, 2 reserved.
///
/// x = d cos(phi) cos(theta - 90 deg), y = d cos(phi) sin(theta - 90 deg), z = d sin(phi). The
/// sensor has no rings: a point's ring is 0.
Expected<LidarPacket, PacketFault> DecodeSpectrumScan(PacketBytes bytes);

PacketDecoder MakeSpectrumScan(const LidarUnit& unit);

}  // namespace voqcal
