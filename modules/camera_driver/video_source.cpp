#include "camera_driver/video_source.hpp"

#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include <opencv2/videoio.hpp>

#include "camera_driver/capture_clock.hpp"
#include "images/encoded_image.hpp"
#include "images/jpeg.hpp"

namespace voqcal {
namespace {

template <typename Clock>
std::int64_t NowUs() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
      .count();
}

const int kMjpeg = cv::VideoWriter::fourcc('M', 'J', 'P', 'G');

// Opens what the options name. MJPEG stays compressed where the backend can leave it so.
cv::VideoCapture Open(const CameraDriverOptions& options) {
  constexpr int kTimeoutMs = 3000;  // a silent network must not stop the heartbeat for longer
  cv::VideoCapture video;
  if (!options.device.empty()) {
    video.open(options.device, cv::CAP_V4L2, {cv::CAP_PROP_FOURCC, kMjpeg});
    // The kernel's driver keeps the format that it has if it knows no MJPEG.
    if (video.isOpened() && static_cast<int>(video.get(cv::CAP_PROP_FOURCC)) == kMjpeg) {
      video.set(cv::CAP_PROP_CONVERT_RGB, 0);
    }
    video.set(cv::CAP_PROP_FPS, options.rate_hz);
    video.set(cv::CAP_PROP_BUFFERSIZE, 2);
  } else if (!options.pipeline.empty()) {
    video.open(options.pipeline, cv::CAP_GSTREAMER);
  } else {
    video.open(
        options.url,
        cv::CAP_FFMPEG,
        {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, kTimeoutMs, cv::CAP_PROP_READ_TIMEOUT_MSEC, kTimeoutMs});
    if (video.isOpened() && static_cast<int>(video.get(cv::CAP_PROP_FOURCC)) == kMjpeg) {
      video.set(cv::CAP_PROP_FORMAT, -1);  // packets, not pictures
    }
  }
  return video;
}

// The bytes of a whole JPEG, if that is what the backend gave instead of a picture.
bool IsJpeg(const cv::Mat& frame) {
  return frame.rows == 1 && frame.type() == CV_8UC1 && frame.cols > 4 && frame.data[0] == 0xFF &&
         frame.data[1] == 0xD8;
}

std::vector<std::uint8_t> Encoded(const cv::Mat& frame, int jpeg_quality) {
  if (IsJpeg(frame)) return {frame.data, frame.data + frame.cols};
  return EncodeJpeg(frame, jpeg_quality);
}

class VideoSource : public CameraSource {
 public:
  explicit VideoSource(const CameraDriverOptions& options)
      : options_(options),
        name_(options.device + options.pipeline + options.url),
        is_file_(!options.url.empty() && options.url.find("://") == std::string::npos) {}

  std::optional<TimedImage> Next() override {
    if (has_ended_ || (!video_.isOpened() && !Connect())) return {};
    cv::Mat frame;
    const bool is_read = video_.grab();
    const CaptureClock::Arrival arrival = {NowUs<std::chrono::system_clock>(),
                                           NowUs<std::chrono::steady_clock>()};
    if (!is_read || !video_.retrieve(frame) || frame.empty()) return WithoutFrame();
    TimedImage image{UtimeOf(arrival), Encoded(frame, options_.jpeg_quality)};
    const auto info = InspectEncodedImage(image.bytes);
    if (is_file_ && !(info && info->has_end)) return WithoutFrame();  // cut off in this frame
    ++num_read_;
    return image;
  }

  bool HasEnded() const override { return has_ended_; }
  bool SetsThePace() const override { return !is_file_; }
  std::string State() const override { return state_; }

 private:
  bool Connect() {
    video_ = Open(options_);
    clock_ = CaptureClock();
    // A file goes on where it was left.
    std::int64_t num_skipped = 0;
    while (is_file_ && num_skipped < num_read_ && video_.grab()) ++num_skipped;
    const bool is_connected = video_.isOpened() && (!is_file_ || num_skipped == num_read_);
    if (!is_connected) video_.release();
    state_ = is_connected ? "running" : "waiting for " + name_;
    return is_connected;
  }

  // No frame came: a file's end, or the loss of what gave them.
  std::optional<TimedImage> WithoutFrame() {
    const auto num_frames = std::llround(video_.get(cv::CAP_PROP_FRAME_COUNT));
    video_.release();
    const bool is_at_end = is_file_ && num_read_ > 0 && num_read_ >= num_frames;
    if (!is_at_end) {
      state_ = "waiting for " + name_ + ", lost after " + std::to_string(num_read_) + " frames";
      return {};
    }
    has_ended_ = !options_.is_repeating;
    if (has_ended_) return {};
    start_us_ += num_read_ * period_us_;
    num_read_ = 0;
    return Next();
  }

  std::int64_t UtimeOf(const CaptureClock::Arrival& arrival) {
    const double stream_ms = video_.get(cv::CAP_PROP_POS_MSEC);
    const std::int64_t stream_us = std::llround(stream_ms * 1e3);
    if (is_file_) {
      const double fps = video_.get(cv::CAP_PROP_FPS);
      period_us_ = std::llround(1e6 / (fps > 0 ? fps : options_.rate_hz));
      return kSyntheticEpochUtime + start_us_ + num_read_ * period_us_;
    }
    if (!options_.device.empty() && stream_ms > 0) {
      // The kernel's monotonic time of the buffer, to the wall clock.
      return stream_us + NowUs<std::chrono::system_clock>() - NowUs<std::chrono::steady_clock>();
    }
    return clock_.UtimeOf(arrival, stream_ms > 0 ? std::optional(stream_us) : std::nullopt);
  }

  CameraDriverOptions options_;
  std::string name_;
  bool is_file_;
  cv::VideoCapture video_;
  CaptureClock clock_;
  std::string state_ = "running";
  bool has_ended_ = false;
  std::int64_t num_read_ = 0;   // of this opening; of a file: since its beginning
  std::int64_t start_us_ = 0;   // of a repeated file: what came before
  std::int64_t period_us_ = 0;  // of a file
};

}  // namespace

std::unique_ptr<CameraSource> MakeVideoSource(const CameraDriverOptions& options) {
  return std::make_unique<VideoSource>(options);
}

}  // namespace voqcal
