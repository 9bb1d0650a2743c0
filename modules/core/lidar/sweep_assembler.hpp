#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/lidar/packet.hpp"

namespace voqcal {

/// One sweep and the time of its first point.
struct TimedSweep {
  std::int64_t utime = 0;
  std::vector<PacketReturn> returns;  ///< point.time_s counts from utime.

  PointCloud Cloud(bool has_ring) const;
};

/// Where a sweep ends.
enum class SweepEnd {
  kAtAzimuth,  ///< The head passes an azimuth, in growing order.
  kAtJump,     ///< The azimuth jumps by more than 30 degrees (Spectrum-Scan: back to the start).
};

/// Gathers returns to sweeps. A pause of half a turn's usual time ends a sweep too.
class SweepAssembler {
 public:
  SweepAssembler(SweepEnd end, double split_azimuth_rad)
      : end_(end), split_azimuth_rad_(split_azimuth_rad) {}

  /// Adds a packet whose first measurement was at `utime`; the sweeps that it ends are appended.
  void Add(const LidarPacket& packet, std::int64_t utime, std::vector<TimedSweep>* ended);

  /// What has been gathered of the sweep that is not at its end.
  std::optional<TimedSweep> Finish();

 private:
  bool Begins(double azimuth_rad, std::int64_t utime);

  SweepEnd end_;
  double split_azimuth_rad_;
  std::optional<double> previous_rad_;  // from the split, of the last return
  std::int64_t previous_utime_ = 0;
  TimedSweep sweep_;
};

}  // namespace voqcal
