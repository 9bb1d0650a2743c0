#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "lidar_driver/lidar_source.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "messaging/pacer.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Publishes the source's sweeps as LIDAR_POINTS at the rig's rate; done when the source has ended.
class LidarDriverNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  LidarDriverNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "lidar_driver"; }
  std::string State() const override { return is_done_ ? "source ended" : "running"; }
  bool Step() override;
  std::optional<std::chrono::steady_clock::time_point> NextStep() const override {
    return pacer_.Next();
  }
  bool IsDone() const override { return is_done_; }

 private:
  std::string channel_;
  Bus& bus_;
  std::unique_ptr<LidarSource> source_;
  Pacer pacer_;
  std::int32_t seq_ = 0;
  bool is_done_ = false;
};

}  // namespace voqcal
