#include "sample_collector/frame_buffer.hpp"

#include <algorithm>
#include <utility>

namespace voqcal {

void FrameBuffer::Add(SensorFrame frame) {
  num_bytes_ += frame.bytes.size();
  newest_utime_ = frame.utime;
  frames_.push_back(std::move(frame));
  while (num_bytes_ > max_bytes_) {
    num_bytes_ -= frames_.front().bytes.size();
    frames_.pop_front();
  }
}

const SensorFrame* FrameBuffer::Find(std::int64_t utime) const {
  const auto found =
      std::find_if(frames_.rbegin(), frames_.rend(), [utime](const SensorFrame& frame) {
        return frame.utime == utime;
      });
  return found == frames_.rend() ? nullptr : &*found;
}

// By the order of arrival: a recording that is played again sets the time back. The oldest frame of
// that time is the judged one then, as detectors answer in order.
void FrameBuffer::ForgetJudged(std::int64_t utime, const std::vector<std::int64_t>& utimes_in_use) {
  const auto judged =
      std::find_if(frames_.begin(), frames_.end(), [utime](const SensorFrame& frame) {
        return frame.utime == utime;
      });
  if (judged == frames_.end()) return;
  const auto kept = std::remove_if(frames_.begin(), judged, [&](const SensorFrame& frame) {
    const auto& in_use = utimes_in_use;
    if (std::find(in_use.begin(), in_use.end(), frame.utime) != in_use.end()) return false;
    num_bytes_ -= frame.bytes.size();
    return true;
  });
  frames_.erase(kept, judged);
}

}  // namespace voqcal
