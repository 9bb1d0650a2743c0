#pragma once

#include <string>
#include <vector>

#include "core/expected.hpp"
#include "core/lidar/packet.hpp"

namespace voqcal {

/// What is known of one unit.
struct Vlp16Options {
  /// Of each ring, lowest first; the factory's -15, -13 .. 15 degrees if empty.
  std::vector<double> elevations_rad;
  double distance_offset_m = 0.0;      ///< By which every range reads long.
  std::vector<double> ring_offsets_m;  ///< By which each ring reads long besides; empty: none.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

constexpr std::uint32_t kVlp16ClockUs = 3600000000U;  ///< The sensor counts within the hour.
constexpr double kVlp16PacketUs = 12 * 110.592;       ///< From packet to packet; half in dual mode.

/// Decodes a data packet of a Velodyne VLP-16 (VLP-16 User Manual, 63-9243, chapter 9), in single
/// or dual return mode. Beams without an echo are left out.
Expected<LidarPacket, PacketFault> DecodeVlp16(PacketBytes bytes, const Vlp16Options& options);

}  // namespace voqcal
