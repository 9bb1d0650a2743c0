#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// The payload of one datagram, borrowed.
struct PacketBytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Why a datagram is not one of the sensor's.
enum class PacketFault {
  kWrongSize,   ///< Not the length of a data packet.
  kAlien,       ///< The right length, but of another sensor or kind.
  kUnknownMode  ///< Of this sensor, in a return mode that is not known.
};

std::string ToString(PacketFault fault);  ///< "wrong size", ... as MODULE_STATUS counts them.

/// Which of a beam's echoes a return is.
enum class ReturnKind {
  kOnly,   ///< The sensor reports one, or both are the same.
  kLast,   ///< Of two: the last.
  kOther,  ///< Of two: the strongest, or the second strongest if the last is the strongest.
};

/// One echo.
struct PacketReturn {
  LidarPoint point;          ///< Its time is set when the sweep is complete.
  double azimuth_rad = 0.0;  ///< Of the sensor's own scan angle, in [0, 2 pi).
  double distance_m = 0.0;   ///< As measured, without corrections.
  double after_packet_us = 0.0;
  ReturnKind kind = ReturnKind::kOnly;
};

/// What one packet says.
struct LidarPacket {
  std::uint32_t sensor_us = 0;        ///< The sensor's clock, which wraps.
  std::vector<PacketReturn> returns;  ///< In the order of their times.
  bool is_dual = false;               ///< Two returns of each beam: half as long as others.
};

}  // namespace voqcal
