#include "camera_driver/exposure_clock.hpp"

#include <cstdlib>
#include <optional>
#include <stdexcept>

namespace voqcal {

std::int64_t ExposureClock::UtimeOf(const Frame& frame) {
  constexpr std::int64_t kMaxApartUs = 1'000'000;
  if (kind_ == Kind::kNone) {
    const bool is_of_host = std::abs(frame.camera_us - frame.arrival.utime) < kMaxApartUs;
    kind_ = is_of_host ? Kind::kCamera : Kind::kArrival;
  }
  if (kind_ == Kind::kCamera) return frame.camera_us + frame.exposure_us / 2;
  const bool has_time = frame.camera_us != 0;
  const auto own_us = has_time ? std::optional(frame.camera_us) : std::nullopt;
  return arrivals_.UtimeOf(frame.arrival, own_us) - frame.exposure_us / 2;
}

std::string ExposureClock::Words() const {
  switch (kind_) {
    case Kind::kNone:
      return "no frame yet";
    case Kind::kCamera:
      return "the camera's clock, which agrees with this host's, and half the exposure";
    case Kind::kArrival:
      return "this host's at a frame's arrival (the camera's clock is another), less half the "
             "exposure";
  }
  throw std::logic_error("ExposureClock: unknown kind");
}

}  // namespace voqcal
