#pragma once

#include <cstdint>
#include <optional>

namespace voqcal {

/// Turns a stream's own times into capture times. A stream counts from a start of its own; what its
/// frames' arrival times add to that is its offset and each frame's delay. The delay varies, so the
/// least of the sums is nearest to the offset:
///     utime = stream time + min over frames (arrival - stream time)
/// which is late by the least delay only. The minimum may rise by 100 us a second, more than
/// quartz clocks drift apart. It is kept in steady time: when the wall clock is set, captures
/// follow it at once.
class CaptureClock {
 public:
  /// When a frame came.
  struct Arrival {
    std::int64_t utime = 0;      ///< By the wall clock, us since the Unix epoch.
    std::int64_t steady_us = 0;  ///< By a clock that nobody sets.
  };

  /// @param stream_us  the stream's time of it; nothing if it has none: it then came at once.
  std::int64_t UtimeOf(const Arrival& arrival, std::optional<std::int64_t> stream_us);

 private:
  std::optional<double> offset_us_;  // of the stream to steady time
  std::int64_t last_arrival_us_ = 0;
};

}  // namespace voqcal
