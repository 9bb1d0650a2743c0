#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

/// One sweep and the time of its first point.
struct TimedSweep {
  std::int64_t utime = 0;
  std::vector<PacketReturn> returns;  ///< point.time_s counts from utime.

  PointCloud Cloud(bool has_ring) const;
};

/// Where a sweep ends.
enum class SweepEnd {
  kAtAzimuth,  ///< Where a beam passes an azimuth, in growing order: each beam for itself.
  kAtJump,     ///< Where the azimuth jumps by more than 30 degrees, back to the start.
  kAtFrame,    ///< Where the sensor says so: LidarPacket::frame changes.
  kAtTime,     ///< Every 100 ms: a sensor without begin or end.
};

/// Gathers returns to sweeps. A pause of half a turn's usual time ends a sweep too.
class SweepAssembler {
 public:
  /// @param overlap_rad  for kAtAzimuth: so far beams may be ahead of the head, or behind it. A
  ///     sweep is complete when the head is past its end by that.
  SweepAssembler(SweepEnd end, double split_azimuth_rad, double overlap_rad)
      : end_(end), split_azimuth_rad_(split_azimuth_rad), overlap_rad_(overlap_rad) {}

  /// Adds a packet whose first measurement was at `utime`; the sweeps that it ends are appended.
  void Add(const LidarPacket& packet, std::int64_t utime, std::vector<TimedSweep>* ended);

  /// What has been gathered of sweeps that are not at their ends.
  void Finish(std::vector<TimedSweep>* ended);

 private:
  /// A sweep that is not complete; times count from `base_utime`.
  struct Open {
    std::int64_t base_utime = 0;
    std::vector<PacketReturn> returns;
  };

  /// The number of the sweep that a return belongs to; it grows by one from sweep to sweep.
  std::int64_t SweepOf(const PacketReturn& measured, const LidarPacket& packet, std::int64_t utime);
  std::int64_t SweepAtAzimuth(double azimuth_rad);
  std::int64_t SweepAtJump(double azimuth_rad);
  /// True if no beam will come any more that belongs before this sweep.
  bool IsPast(std::int64_t number) const;
  void CloseBefore(std::int64_t number, std::vector<TimedSweep>* ended);

  SweepEnd end_;
  double split_azimuth_rad_;
  double overlap_rad_;
  std::map<std::int64_t, Open> open_;   // by number
  std::int64_t oldest_ = INT64_MIN;     // number of the oldest sweep that may still grow
  std::optional<double> previous_rad_;  // azimuth from the split, of the last return, unwrapped
  std::int64_t previous_utime_ = 0;
  std::int64_t num_jumps_ = 0;
  std::int64_t newest_frame_ = 0;  // unwrapped
};

}  // namespace voqcal
