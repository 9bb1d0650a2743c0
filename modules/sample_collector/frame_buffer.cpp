#include "sample_collector/frame_buffer.hpp"

#include <algorithm>
#include <utility>

namespace voqcal {

void FrameBuffer::Add(SensorFrame frame) {
  num_bytes_ += frame.bytes.size();
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

std::optional<std::int64_t> FrameBuffer::NewestUtime() const {
  if (frames_.empty()) return std::nullopt;
  return frames_.back().utime;
}

}  // namespace voqcal
