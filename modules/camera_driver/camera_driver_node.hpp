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

/// Publishes the source's images as CAMERA_IMAGE, each with its CAMERA_INFO, at the rig's rate;
/// done when the source has ended.
class CameraDriverNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  CameraDriverNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "camera_driver"; }
  std::string State() const override { return is_done_ ? "source ended" : "running"; }
  bool Step() override;
  std::optional<std::chrono::steady_clock::time_point> NextStep() const override {
    return pacer_.Next();
  }
  bool IsDone() const override { return is_done_; }

 private:
  Channels channels_;
  CameraModel camera_;
  Bus& bus_;
  std::unique_ptr<CameraSource> source_;
  Pacer pacer_;
  std::int64_t seq_ = 0;
  bool is_done_ = false;
};

}  // namespace voqcal
