#pragma once

#include <chrono>

namespace voqcal {

/// Paces a driver: frame n is due n / rate after the first. A late frame does not delay those after
/// it, but what was missed by more than a second is not caught up with in a burst.
class Pacer {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param rate_hz  frames a second, positive.
  explicit Pacer(double rate_hz)
      : period_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1.0 / rate_hz))),
        next_(Clock::now()) {}

  Clock::time_point Next() const { return next_; }
  void Advance() {
    next_ += period_;
    const Clock::time_point now = Clock::now();
    if (next_ + std::chrono::seconds(1) < now) next_ = now;
  }

 private:
  Clock::duration period_;
  Clock::time_point next_;
};

}  // namespace voqcal
