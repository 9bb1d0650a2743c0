#include "camera_driver/capture_clock.hpp"

#include <algorithm>

namespace voqcal {

std::int64_t CaptureClock::UtimeOf(std::int64_t arrival_utime,
                                   std::optional<std::int64_t> stream_us) {
  if (!stream_us) return arrival_utime;
  constexpr std::int64_t kDriftFraction = 10'000;  // 1 / 100 ppm
  const std::int64_t sum_us = arrival_utime - *stream_us;
  if (offset_us_) {
    const std::int64_t elapsed_us = std::max<std::int64_t>(0, arrival_utime - last_arrival_utime_);
    offset_us_ = std::min(sum_us, *offset_us_ + elapsed_us / kDriftFraction);
  } else {
    offset_us_ = sum_us;
  }
  last_arrival_utime_ = arrival_utime;
  return *stream_us + *offset_us_;
}

}  // namespace voqcal
