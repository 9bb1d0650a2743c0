#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "camera_driver/camera_source.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "messaging/pacer.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Publishes the source's images as CAMERA_IMAGE, each with its CAMERA_INFO, at the rig's rate or
/// the camera's own; done when the source has ended. A source that waits for its camera is asked
/// again after the rig's retry_s; each loss and each return is counted.
class CameraDriverNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  CameraDriverNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "camera_driver"; }
  std::string State() const override { return is_done_ ? "source ended" : source_->State(); }
  bool Step() override;
  std::optional<std::chrono::steady_clock::time_point> NextStep() const override { return next_; }
  bool IsDone() const override { return is_done_; }

 private:
  void Publish(TimedImage image);
  /// Counts losses of the camera and its returns.
  void NoteState(bool has_image);

  Channels channels_;
  CameraModel camera_;
  Bus& bus_;
  std::unique_ptr<CameraSource> source_;
  Pacer pacer_;
  std::chrono::steady_clock::duration retry_;
  std::chrono::steady_clock::time_point next_;  ///< When Step may ask the source again.
  bool is_waiting_ = false;                     ///< The source has lost its camera.
  std::int64_t seq_ = 0;
  bool is_done_ = false;
};

}  // namespace voqcal
