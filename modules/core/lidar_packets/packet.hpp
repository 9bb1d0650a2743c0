#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/expected.hpp"
#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// The payload of one datagram, borrowed.
struct PacketBytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Why a datagram has no points.
enum class PacketFault {
  kWrongSize,          ///< Not the length of a data packet.
  kAlien,              ///< The right length, but of another sensor or kind.
  kUnknownMode,        ///< Of this sensor, in a return mode that is not known.
  kWithoutPoints,      ///< Of this sensor, but it measured nothing: motion, position, calibration.
  kWithoutCalibration  ///< Of this sensor, whose angles are not known yet.
};

std::string ToString(PacketFault fault);  ///< "packets of a wrong size", ... as they are counted.

/// One echo.
struct PacketReturn {
  LidarPoint point;          ///< Its time is set when the sweep is complete.
  double azimuth_rad = 0.0;  ///< By which sweeps are told apart, clockwise, in [0, 2 pi).
  double distance_m = 0.0;   ///< As measured, without corrections.
  double after_packet_us = 0.0;
  int number = 1;  ///< Of its beam's echoes that the sensor reports, the nearest first.
  int of_how_many = 1;
};

/// What one packet says.
struct LidarPacket {
  std::int64_t sensor_us = 0;           ///< The sensor's clock, which may wrap.
  std::vector<PacketReturn> returns;    ///< Echoes of one beam next to each other.
  double period_us = 0.0;               ///< From packet to packet; 0: not steady.
  std::optional<std::uint32_t> number;  ///< If the sensor counts its packets.
  std::int64_t frame = 0;  ///< If the sensor counts its sweeps; may wrap after 16 bits.
};

/// Bytes to points. What it remembers from packet to packet, if anything, is the sensor's own word
/// on its calibration or speed.
using PacketDecoder = std::function<Expected<LidarPacket, PacketFault>(PacketBytes)>;

/// What is known of one unit.
struct LidarUnit {
  std::string calibration;             ///< What the vendor's file says; empty: angles as published.
  std::vector<double> elevations_rad;  ///< Of each ring, lowest first, before all else; or empty.
  double distance_offset_m = 0.0;      ///< By which every range reads long.
  std::vector<double> ring_offsets_m;  ///< By which each ring reads long besides; empty: none.
};

}  // namespace voqcal
