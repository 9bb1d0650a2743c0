#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace voqcal {

/// One sensor message as it was sent, with its capture time.
struct SensorFrame {
  std::int64_t utime = 0;
  std::vector<std::uint8_t> bytes;
};

/// The latest frames of one sensor, as many as fit, until they are judged: a sample is decided when
/// both detectors have passed its time, some frames after the sensors saw it.
class FrameBuffer {
 public:
  explicit FrameBuffer(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  void Add(SensorFrame frame);

  /// The latest frame of that capture time; null if there is none (any more).
  const SensorFrame* Find(std::int64_t utime) const;

  /// The detector is done with the frame of that time: those that came before it go, but for those
  /// of the times in use.
  void ForgetJudged(std::int64_t utime, const std::vector<std::int64_t>& utimes_in_use);

  /// Of the frame that came last, kept or not; nothing if none did.
  std::optional<std::int64_t> NewestUtime() const { return newest_utime_; }
  std::size_t num_bytes() const { return num_bytes_; }

 private:
  std::size_t max_bytes_;
  std::size_t num_bytes_ = 0;
  std::optional<std::int64_t> newest_utime_;
  std::deque<SensorFrame> frames_;
};

}  // namespace voqcal
