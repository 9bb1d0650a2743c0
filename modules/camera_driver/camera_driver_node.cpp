#include "camera_driver/camera_driver_node.hpp"

#include <utility>

#include "images/encoded_image.hpp"
#include "messaging/convert_image.hpp"

namespace voqcal {

using Clock = std::chrono::steady_clock;

namespace {

constexpr std::chrono::milliseconds kReadyPoll{10};

}  // namespace

CameraDriverNode::CameraDriverNode(const Rig& rig, Bus* bus)
    : channels_(rig.channels),
      camera_(rig.camera),
      bus_(*bus),
      source_(MakeCameraSource(rig, bus)),
      pacer_(rig.camera_driver.rate_hz),
      retry_(std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(rig.camera_driver.retry_s))),
      next_(pacer_.Next()) {}

bool CameraDriverNode::Step() {
  if (is_done_ || Clock::now() < next_) return false;
  if (!source_->IsReady()) {
    next_ = Clock::now() + kReadyPoll;
    return false;
  }
  std::optional<TimedImage> image = source_->Next();
  is_done_ = !image && source_->HasEnded();
  if (is_done_) return false;
  NoteState(image.has_value());
  if (!image) {
    next_ = Clock::now() + retry_;
    return false;
  }
  Publish(std::move(*image));
  pacer_.Advance();
  next_ = source_->SetsThePace() ? Clock::now() : pacer_.Next();
  return false;
}

void CameraDriverNode::NoteState(bool has_image) {
  if (!has_image && !is_waiting_) Count("camera lost");
  if (has_image && is_waiting_) Count("camera found again");
  is_waiting_ = !has_image;
}

void CameraDriverNode::Publish(TimedImage image) {
  if (!InspectEncodedImage(image.bytes)) return Count("unreadable images");
  bus_.Publish(channels_.camera_info, ToMessage(camera_, image.utime, seq_));
  bus_.Publish(channels_.camera_image, EncodedToMessage(std::move(image.bytes), image.utime, seq_));
  ++seq_;
  Count("images");
}

}  // namespace voqcal
