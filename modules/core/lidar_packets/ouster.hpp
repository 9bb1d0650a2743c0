#pragma once

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

/// Ouster's OS-0, OS-1 and OS-2 (Software User Manual, "Lidar Data Packet Format"), in the profiles
/// LEGACY, RNG19_RFL8_SIG16_NIR16 (also _DUAL), RNG15_RFL8_NIR8 (also _DUAL) and
/// FUSA_RNG15_RFL8_NIR8_DUAL. The calibration is the sensor's metadata (JSON, of either kind): it
/// has the format too, so nothing can be decoded without it.
///
/// Points are in Ouster's sensor frame, x forward; intensity is the calibrated reflectivity.
/// PacketReturn::azimuth_rad is the encoder's.
PacketDecoder MakeOuster(const LidarUnit& unit);

}  // namespace voqcal
