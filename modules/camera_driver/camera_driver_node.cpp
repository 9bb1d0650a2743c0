#include "camera_driver/camera_driver_node.hpp"

#include <utility>

#include "messaging/convert_image.hpp"

namespace voqcal {

CameraDriverNode::CameraDriverNode(const Rig& rig, Bus* bus)
    : channels_(rig.channels),
      camera_(rig.camera),
      bus_(*bus),
      source_(MakeCameraSource(rig)),
      pacer_(rig.camera_driver.rate_hz) {}

bool CameraDriverNode::Step() {
  if (is_done_ || !pacer_.IsDue()) return false;
  std::optional<TimedImage> image = source_->Next();
  if (!image) {
    is_done_ = true;
    return false;
  }
  bus_.Publish(channels_.camera_info, ToMessage(camera_, image->utime, seq_));
  bus_.Publish(channels_.camera_image,
               EncodedToMessage(std::move(image->bytes), image->utime, seq_));
  ++seq_;
  Count("images");
  pacer_.Advance();
  return false;
}

}  // namespace voqcal
