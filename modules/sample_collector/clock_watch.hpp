#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace voqcal {

/// Whether both sensors tell the time of one clock: compares the capture times of frames that
/// arrive one after the other.
class ClockWatch {
 public:
  void TakeLidar(std::int64_t utime) { Take(utime, &newest_lidar_utime_, newest_camera_utime_, 1); }
  void TakeCamera(std::int64_t utime) {
    Take(utime, &newest_camera_utime_, newest_lidar_utime_, -1);
  }

  /// Frames of both were of one time: what arrives late is late, and the clocks agree.
  void NotePair() { camera_ahead_us_.clear(); }

  /// How far the camera's clock is ahead of the lidar's, seconds; nothing while they agree to a
  /// second, which frames may take to arrive, or while it cannot be told.
  std::optional<double> CameraAheadS() const;

  /// "the camera's clock is 3600.0 s ahead of the lidar's: ...; REMEDY"; empty if they agree.
  std::string Trouble() const;

 private:
  void Take(std::int64_t utime,
            std::optional<std::int64_t>* own,
            const std::optional<std::int64_t>& other,
            int sensor);

  std::optional<std::int64_t> newest_lidar_utime_;
  std::optional<std::int64_t> newest_camera_utime_;
  int last_sensor_ = 0;
  std::deque<std::int64_t> camera_ahead_us_;  // where a frame of one came after one of the other
};

}  // namespace voqcal
