#pragma once

#include <cstdint>
#include <string>

#include "camera_driver/capture_clock.hpp"

namespace voqcal {

/// The middle of each frame's exposure.
///
/// A camera whose clock agrees with this host's within a second (PTP in UTC, or a driver that
/// stamps on the host) says when the exposure began: half of it is added. Another camera's clock,
/// since boot mostly, only says how far frames are apart (CaptureClock); when they are is told by
/// their arrival, which begins when the exposure has ended: half of it is taken off, and the times
/// are late by the least time that read-out and network take.
class ExposureClock {
 public:
  struct Frame {
    std::int64_t camera_us = 0;     ///< The camera's own time of the frame; 0 if it has none.
    CaptureClock::Arrival arrival;  ///< Of its first packet.
    std::int64_t exposure_us = 0;   ///< 0 if the camera does not tell.
  };

  /// The clock is chosen by the first frame.
  std::int64_t UtimeOf(const Frame& frame);

  /// Which clock is used, for the log; after the first frame.
  std::string Words() const;

 private:
  enum class Kind { kNone, kCamera, kArrival };

  Kind kind_ = Kind::kNone;
  CaptureClock arrivals_;
};

}  // namespace voqcal
