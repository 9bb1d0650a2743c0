#include "sample_collector/clock_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/format.hpp"

namespace voqcal {
namespace {

// A pause of one sensor, or a jump of both clocks, shows once: only what stays is the clocks'.
constexpr std::size_t kNumCompared = 6;
constexpr std::int64_t kAgreementUs = 1'000'000;

std::string Duration(double seconds) {
  if (seconds < 120) return Format("%.1f s", seconds);
  if (seconds < 7200) return Format("%.1f s (%.0f min)", seconds, seconds / 60);
  return Format("%.0f s (%.1f h)", seconds, seconds / 3600);
}

}  // namespace

void ClockWatch::Take(std::int64_t utime,
                      std::optional<std::int64_t>* own,
                      const std::optional<std::int64_t>& other,
                      int sensor) {
  *own = utime;
  const bool is_turn = last_sensor_ == -sensor;
  last_sensor_ = sensor;
  if (!other || !is_turn) return;
  camera_ahead_us_.push_back(*newest_camera_utime_ - *newest_lidar_utime_);
  if (camera_ahead_us_.size() > kNumCompared) camera_ahead_us_.pop_front();
}

std::optional<double> ClockWatch::CameraAheadS() const {
  if (camera_ahead_us_.size() < kNumCompared) return {};
  const std::int64_t least_us = *std::min_element(
      camera_ahead_us_.begin(), camera_ahead_us_.end(), [](std::int64_t a, std::int64_t b) {
        return std::llabs(a) < std::llabs(b);
      });
  if (std::llabs(least_us) < kAgreementUs) return {};
  return 1e-6 * static_cast<double>(least_us);
}

std::string ClockWatch::Trouble() const {
  const std::optional<double> ahead_s = CameraAheadS();
  if (!ahead_s) return {};
  return "The camera's clock is " + Duration(std::abs(*ahead_s)) +
         (*ahead_s > 0 ? " ahead of" : " behind") +
         " the lidar's, so that no two frames are of one time; set both by one clock (PTP or NTP) "
         "and start them again";
}

}  // namespace voqcal
