#include "camera_driver/capture_clock.hpp"

#include <algorithm>
#include <cmath>

namespace voqcal {

std::int64_t CaptureClock::UtimeOf(const Arrival& arrival, std::optional<std::int64_t> stream_us) {
  if (!stream_us) return arrival.utime;
  constexpr double kDrift = 100e-6;
  const auto sum_us = static_cast<double>(arrival.steady_us - *stream_us);
  const auto elapsed_us = static_cast<double>(arrival.steady_us - last_arrival_us_);
  offset_us_ = offset_us_ ? std::min(sum_us, *offset_us_ + kDrift * elapsed_us) : sum_us;
  last_arrival_us_ = arrival.steady_us;
  const std::int64_t delay_us = std::llround(sum_us - *offset_us_);
  return arrival.utime - delay_us;
}

}  // namespace voqcal
