#pragma once

#include <cstdint>
#include <optional>

namespace voqcal {

/// Turns a stream's own times into capture times. A stream counts from a start of its own; what its
/// frames' arrival times add to that is its offset and each frame's delay. The delay varies, so the
/// least of the sums is nearest to the offset:
///     utime = stream time + min over frames (arrival - stream time)
/// which is late by the least delay only. The minimum may rise by 100 us a second, more than
/// quartz clocks drift apart.
class CaptureClock {
 public:
  /// @param arrival_utime  when the frame came, us since the Unix epoch.
  /// @param stream_us      the stream's time of it; nothing if it has none: it then came at once.
  std::int64_t UtimeOf(std::int64_t arrival_utime, std::optional<std::int64_t> stream_us);

 private:
  std::optional<std::int64_t> offset_us_;
  std::int64_t last_arrival_utime_ = 0;
};

}  // namespace voqcal
