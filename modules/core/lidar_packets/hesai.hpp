#pragma once

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

// Hesai's spinning lidars (user manuals, chapter "Data Structure"): a header (but for the
// Pandar40P), blocks of an azimuth and all lasers, and a tail with return mode, date, time and
// often a number. With two or three returns, neighbouring blocks hold those of one firing.
//
// Azimuth 0 is along y, as in Hesai's own frame and drivers. A unit's calibration is its angle
// correction file (CSV: channel, elevation, azimuth in degrees). Without it QT64, XT32M and OT128
// take the vendor's published angles. Those of 40P, 64, QT128, XT16 and XT32 were recovered from
// clouds that another decoder made of one unit's packets: another unit differs by some tenths of a
// degree.

PacketDecoder MakeHesai40p(const LidarUnit& unit);
PacketDecoder MakeHesai64(const LidarUnit& unit);
PacketDecoder MakeHesaiQt64(const LidarUnit& unit);
PacketDecoder MakeHesaiQt128(const LidarUnit& unit);
PacketDecoder MakeHesaiXt16(const LidarUnit& unit);
PacketDecoder MakeHesaiXt32(const LidarUnit& unit);
PacketDecoder MakeHesaiXt32m(const LidarUnit& unit);
PacketDecoder MakeHesaiOt128(const LidarUnit& unit);

}  // namespace voqcal
