#include "camera_driver/genicam_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <arv.h>
#include <spdlog/spdlog.h>

#include "camera_driver/exposure_clock.hpp"
#include "camera_driver/genicam_pixels.hpp"
#include "images/jpeg.hpp"

namespace voqcal {
namespace {

constexpr int kNumBuffers = 4;  // one to be filled, one that is looked at, two for a slow moment

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
using CameraPtr = std::unique_ptr<ArvCamera, Unref>;
using StreamPtr = std::unique_ptr<ArvStream, Unref>;

/// Where a call of Aravis puts what went wrong.
class ArvError {
 public:
  ArvError() = default;
  ArvError(const ArvError&) = delete;
  ArvError& operator=(const ArvError&) = delete;
  ~ArvError() { g_clear_error(&error_); }

  /// To be given to a call; what was there is forgotten.
  GError** Out() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }

  /// @throws std::runtime_error if there is one.
  void ThrowIfSet() const {
    if (error_ != nullptr) throw std::runtime_error(error_->message);
  }

 private:
  GError* error_ = nullptr;
};

std::string TextOf(const char* text) { return text == nullptr ? "" : text; }

/// "Basler-acA1920-40gc-12345678 (192.168.1.20)" of each camera that Aravis finds now.
std::vector<std::string> FoundCameras() {
  std::vector<std::string> cameras;
  for (unsigned int i = 0; i < arv_get_n_devices(); ++i) {
    cameras.push_back(TextOf(arv_get_device_id(i)) + " (" + TextOf(arv_get_device_address(i)) +
                      ")");
  }
  return cameras;
}

std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

/// @param id  as Aravis lists it, or the camera's address, serial number or own name; empty: the
///     only one there is, whose id it becomes.
/// @throws std::runtime_error naming the cameras that there are.
CameraPtr OpenCamera(std::string* id) {
  arv_update_device_list();
  const std::vector<std::string> found = FoundCameras();
  if (id->empty() && found.size() != 1) {
    throw std::runtime_error("camera_driver.camera_id must name one of the cameras here: " +
                             Listed(found));
  }
  if (id->empty()) *id = TextOf(arv_get_device_id(0));
  ArvError error;
  CameraPtr camera(arv_camera_new(id->c_str(), error.Out()));
  if (!camera) {
    throw std::runtime_error("no camera " + *id + "; cameras here: " + Listed(found));
  }
  return camera;
}

std::vector<std::string> PixelFormatsOf(ArvCamera* camera) {
  ArvError error;
  guint num = 0;
  const std::unique_ptr<const char*, void (*)(gpointer)> names(
      arv_camera_dup_available_pixel_formats_as_strings(camera, &num, error.Out()), g_free);
  return names ? std::vector<std::string>(names.get(), names.get() + num)
               : std::vector<std::string>();
}

/// The camera's own format if it is known here; else the best known one that it has.
void ChoosePixelFormat(ArvCamera* camera) {
  ArvError error;
  const auto now = static_cast<std::uint32_t>(arv_camera_get_pixel_format(camera, error.Out()));
  error.ThrowIfSet();
  if (IsKnownPixelFormat(now)) return;
  const std::vector<std::string> offered = PixelFormatsOf(camera);
  for (const std::string& name : KnownPixelFormatNames()) {
    if (std::find(offered.begin(), offered.end(), name) == offered.end()) continue;
    arv_camera_set_pixel_format_from_string(camera, name.c_str(), error.Out());
    error.ThrowIfSet();
    spdlog::info("the camera's pixel format is not known here: it is set to {}", name);
    return;
  }
  throw std::runtime_error("the camera has the pixel formats " + Listed(offered) +
                           "; wanted is one of " + Listed(KnownPixelFormatNames()));
}

/// A camera that is triggered is left to its trigger, which a rate of its own would end.
void SetRate(ArvCamera* camera, double rate_hz) {
  ArvError error;
  const bool has_trigger = arv_camera_is_feature_available(camera, "TriggerMode", error.Out());
  const std::string mode =
      has_trigger ? TextOf(arv_camera_get_string(camera, "TriggerMode", error.Out())) : "";
  if (mode == "On" || !arv_camera_is_frame_rate_available(camera, error.Out())) return;
  arv_camera_set_frame_rate(camera, rate_hz, error.Out());
  if (error) spdlog::warn("the camera keeps its own rate: it refuses {} Hz", rate_hz);
}

void Configure(ArvCamera* camera, double rate_hz) {
  ArvError error;
  arv_camera_set_acquisition_mode(camera, ARV_ACQUISITION_MODE_CONTINUOUS, error.Out());
  error.ThrowIfSet();
  ChoosePixelFormat(camera);
  SetRate(camera, rate_hz);
}

/// Frames are on their way once it is there, until it is destroyed.
class Acquisition {
 public:
  /// @throws std::runtime_error naming the cause.
  Acquisition(std::string id, double rate_hz) : camera_(OpenCamera(&id)), id_(std::move(id)) {
    Configure(camera_.get(), rate_hz);
    ArvError error;
    stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, error.Out()));
    error.ThrowIfSet();
    const guint num_bytes = arv_camera_get_payload(camera_.get(), error.Out());
    error.ThrowIfSet();
    for (int i = 0; i < kNumBuffers; ++i) {
      arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(num_bytes));
    }
    arv_camera_start_acquisition(camera_.get(), error.Out());
    error.ThrowIfSet();
  }
  Acquisition(const Acquisition&) = delete;
  Acquisition& operator=(const Acquisition&) = delete;
  ~Acquisition() {
    ArvError error;
    arv_camera_stop_acquisition(camera_.get(), error.Out());
  }

  /// Calls `use` with the next frame, whole or not; false if none came in time.
  template <typename Use>
  bool WithNext(std::chrono::microseconds timeout, const Use& use) {
    ArvBuffer* const buffer =
        arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(timeout.count()));
    if (buffer == nullptr) return false;
    const std::unique_ptr<ArvBuffer, PushBack> held(buffer, PushBack{stream_.get()});
    use(buffer);
    return true;
  }

  /// 0 if the camera does not tell.
  std::int64_t ExposureUs() const {
    ArvError error;
    if (!arv_camera_is_exposure_time_available(camera_.get(), error.Out())) return 0;
    const double exposure_us = arv_camera_get_exposure_time(camera_.get(), error.Out());
    return error ? 0 : std::llround(exposure_us);
  }

  const std::string& id() const { return id_; }

 private:
  struct PushBack {
    ArvStream* stream;
    void operator()(ArvBuffer* buffer) const { arv_stream_push_buffer(stream, buffer); }
  };

  CameraPtr camera_;
  std::string id_;
  StreamPtr stream_;
};

template <typename Clock>
std::int64_t NowUs() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
      .count();
}

/// Aravis keeps when a frame's first packet came by the wall clock.
CaptureClock::Arrival ArrivalOf(ArvBuffer* buffer) {
  const auto utime = static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer) / 1000);
  const std::int64_t ago_us = NowUs<std::chrono::system_clock>() - utime;
  return {utime, NowUs<std::chrono::steady_clock>() - ago_us};
}

GenicamFrame FrameOf(ArvBuffer* buffer) {
  gint padding_x = 0;
  gint padding_y = 0;
  arv_buffer_get_image_padding(buffer, &padding_x, &padding_y);
  std::size_t num_bytes = 0;
  const void* const data = arv_buffer_get_image_data(buffer, &num_bytes);
  return {static_cast<std::uint32_t>(arv_buffer_get_image_pixel_format(buffer)),
          arv_buffer_get_image_width(buffer),
          arv_buffer_get_image_height(buffer),
          padding_x,
          static_cast<const std::uint8_t*>(data),
          num_bytes};
}

class GenicamSource : public CameraSource {
 public:
  explicit GenicamSource(const CameraDriverOptions& options) : options_(options) {}

  std::optional<TimedImage> Next() override {
    constexpr std::chrono::seconds kTimeout{
        3};  // a silent camera must not stop the heartbeat longer
    if (!acquisition_ && (!IsClosed() || !Connect())) return {};
    TimedImage image;
    if (acquisition_->WithNext(kTimeout, [&](ArvBuffer* buffer) { image = ImageOf(buffer); })) {
      return image;
    }
    CloseLost();
    state_ = "waiting for " + name_ + ", lost after " + std::to_string(num_frames_) + " frames";
    return {};
  }

  bool HasEnded() const override { return false; }
  bool SetsThePace() const override { return true; }
  std::string State() const override { return state_; }

 private:
  bool Connect() {
    try {
      acquisition_ = std::make_unique<Acquisition>(options_.camera_id, options_.rate_hz);
    } catch (const std::runtime_error& error) {
      state_ = std::string("waiting for the camera: ") + error.what();
      return false;
    }
    name_ = acquisition_->id();
    clock_ = ExposureClock();
    num_frames_ = 0;
    state_ = "running";
    return true;
  }

  /// A camera that does not answer holds up who takes leave of it for many seconds: beside the
  /// heartbeat.
  void CloseLost() {
    closing_ = std::async(std::launch::async,
                          [lost = std::move(acquisition_)]() mutable { lost.reset(); });
  }

  bool IsClosed() const {
    return !closing_.valid() ||
           closing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  TimedImage ImageOf(ArvBuffer* buffer) {
    // Of a frame with missing packets the camera's own time may be missing, too.
    if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) {
      return {ArrivalOf(buffer).utime, {}};
    }
    const ExposureClock::Frame times{
        static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer) / 1000),
        ArrivalOf(buffer),
        ExposureUs()};
    TimedImage image{clock_.UtimeOf(times), {}};
    if (num_frames_++ == 0) {
      spdlog::info("{}: image times are {} ({} us)", name_, clock_.Words(), exposure_us_ / 2);
    }
    const auto picture = PictureOf(FrameOf(buffer));
    if (picture) image.bytes = EncodeJpeg(*picture, options_.jpeg_quality);
    return image;
  }

  /// Asked for once a second: an automatic exposure changes, and each question takes a millisecond.
  std::int64_t ExposureUs() {
    constexpr std::chrono::seconds kPeriod{1};
    const auto now = std::chrono::steady_clock::now();
    if (num_frames_ == 0 || now >= next_exposure_) {
      exposure_us_ = acquisition_->ExposureUs();
      next_exposure_ = now + kPeriod;
    }
    return exposure_us_;
  }

  CameraDriverOptions options_;
  std::unique_ptr<Acquisition> acquisition_;
  std::future<void> closing_;  // of one that was lost
  ExposureClock clock_;
  std::string name_;
  std::string state_ = "running";
  std::int64_t num_frames_ = 0;  // since the camera was found
  std::int64_t exposure_us_ = 0;
  std::chrono::steady_clock::time_point next_exposure_;
};

}  // namespace

std::unique_ptr<CameraSource> MakeGenicamSource(const Rig& rig) {
  return std::make_unique<GenicamSource>(rig.camera_driver);
}

}  // namespace voqcal
