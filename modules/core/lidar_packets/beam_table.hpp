#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

/// Where one laser of a spinning lidar points, and what else its calibration says.
struct Beam {
  double elevation_rad = 0.0;
  double azimuth_rad = 0.0;      ///< Added to the head's, clockwise.
  double range_m = 0.0;          ///< Added to every range.
  double beside_axis_m = 0.0;    ///< Its origin, to the beam's left seen from above.
  double above_centre_m = 0.0;   ///< Its origin, across the beam.
  double ahead_of_axis_m = 0.0;  ///< Its origin, where the head points.
  int ring = 0;                  ///< Scan line, counted from the lowest.
};

/// By the order in which packets have them.
using BeamTable = std::vector<Beam>;

/// A table by degrees, with rings. The lists are of one length, or `azimuths_deg` is empty.
BeamTable BeamsAt(const std::vector<double>& elevations_deg,
                  const std::vector<double>& azimuths_deg = {});

/// Numbers the beams from the lowest; among beams of one elevation, in the table's order.
void NumberRings(BeamTable* beams);

/// The unit's own elevations, by ring, in place of the table's, if it has any.
void TakeElevations(const LidarUnit& unit, BeamTable* beams);

/// Reads "channel, elevation, azimuth" lines, degrees, channels from 1 (Hesai's files; RoboSense's
/// have no channel). A heading is passed over.
/// @throws std::invalid_argument naming line, rule and value.
BeamTable ReadBeamCsv(const std::string& text, std::size_t num_beams);

/// Where azimuth 0 is: along x (Velodyne, RoboSense) or along y (Hesai), as the vendors have it.
enum class ZeroAzimuth { kAlongX, kAlongY };

/// The echo of a beam while the head stands at `head_rad`, clockwise. PacketReturn::azimuth_rad is
/// the beam's own.
PacketReturn MeasuredBy(
    const Beam& beam, double head_rad, double distance_m, int intensity, ZeroAzimuth zero);

/// One echo as a packet has it.
struct RawEcho {
  int distance = 0;  ///< In the packet's unit; 0: none.
  int intensity = 0;
};

/// A beam's echoes that are different ones, the nearest first. Of two at the same distance, the one
/// that was added first stays.
class BeamEchoes {
 public:
  void Add(RawEcho echo);
  int size() const { return size_; }
  const RawEcho& operator[](int i) const { return echoes_[i]; }

 private:
  static constexpr int kMaxEchoes = 3;

  std::array<RawEcho, kMaxEchoes> echoes_;
  int size_ = 0;
};

}  // namespace voqcal
