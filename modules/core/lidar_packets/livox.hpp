#pragma once

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

// Livox' lidars give points, not beams: they have no rings, and a sweep is what 100 ms hold.
// Multi-byte fields are little-endian.

/// The Mid-360 and the HAP (Livox SDK2 protocol): 36 bytes of header with the number of points, the
/// time from the first to the last (0.1 us), kind and clock (ns), then points: Cartesian in
/// millimetres or centimetres, or spherical.
PacketDecoder MakeLivoxMid360(const LidarUnit& unit);

/// The Avia, Horizon, Tele-15 and Mid-40 (Livox SDK protocol): 18 bytes of header, then points of
/// one, two or three returns, Cartesian or spherical.
PacketDecoder MakeLivoxAvia(const LidarUnit& unit);

}  // namespace voqcal
