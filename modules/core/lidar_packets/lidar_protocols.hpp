#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/lidar_packets/packet.hpp"
#include "core/lidar_packets/sweep_assembler.hpp"

namespace voqcal {

/// How one kind of lidar speaks. All that the project knows of it apart from its decoder: to add
/// a lidar is to write a decoder and its test, and to add a line to the table.
struct LidarProtocol {
  std::string name;        ///< "velodyne_vlp16", as rig files and decode_lidar take it.
  std::string short_name;  ///< Another name that they take, or empty.
  std::string title;       ///< "Velodyne VLP-16 (Puck)".
  int num_rings = 0;       ///< 0: none, or as its calibration says.
  bool has_rings = true;
  int port = 0;                           ///< To which it usually sends.
  std::vector<std::size_t> packet_bytes;  ///< Of its data packets; empty: as its calibration says.
  std::int64_t clock_us = 0;              ///< After which its clock begins anew.
  bool has_utc =
      false;  ///< Its clock is that of the world, within clock_us, if it is synchronised.
  SweepEnd sweep_end = SweepEnd::kAtAzimuth;
  double overlap_rad = 0.0;  ///< By which beams are ahead of the head or behind it.
  std::string calibration;   ///< The vendor's file that it takes, or empty.
  bool needs_calibration = false;
  /// @throws std::invalid_argument saying what is wrong with the unit's calibration.
  PacketDecoder (*make_decoder)(const LidarUnit& unit) = nullptr;
};

/// A clock that does not wrap, in microseconds.
constexpr std::int64_t kEndlessClockUs = std::int64_t{1} << 60;

/// The table: every lidar that is understood.
const std::vector<LidarProtocol>& LidarProtocols();

/// By name or short name; nullptr if there is none.
const LidarProtocol* FindLidarProtocol(const std::string& name);

/// "velodyne_vlp16, hesai_40p, ...", as errors list them.
std::string LidarProtocolNames();

/// Why nothing was understood, and what may have sent it: "no VLP-16 packet among 1439 of 1262
/// bytes: another sensor? 1262 bytes is what hesai_40p sends".
/// @param sizes  how many datagrams had each size.
std::string WrongLidarText(const LidarProtocol& protocol,
                           const std::map<std::size_t, std::int64_t>& sizes);

}  // namespace voqcal
