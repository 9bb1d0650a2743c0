#pragma once

#include <filesystem>

#include "core/lidar_packets/packet_stream.hpp"

namespace voqcal {

/// The stream of a lidar with its vendor's file on this very unit.
/// @param calibration  empty: none.
/// @throws std::runtime_error naming the file and what is wrong with it.
LidarPacketStream CalibratedStream(LidarPacketOptions options,
                                   const std::filesystem::path& calibration);

}  // namespace voqcal
