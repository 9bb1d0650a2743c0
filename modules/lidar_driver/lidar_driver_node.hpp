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

/// Publishes the source's sweeps as LIDAR_POINTS, at the rig's rate or the source's own; done when
/// the source has ended.
class LidarDriverNode : public Module {
 public:
  /// @param bus  borrowed; must outlive the node.
  LidarDriverNode(const Rig& rig, Bus* bus);

  std::string Name() const override { return "lidar_driver"; }
  std::string State() const override { return is_done_ ? "source ended" : source_->State(); }
  bool Step() override;
  std::optional<std::chrono::steady_clock::time_point> NextStep() const override { return next_; }
  bool IsDone() const override { return is_done_; }

 private:
  using Clock = std::chrono::steady_clock;

  /// Makes sure that there is a sweep to publish, if the source has one now.
  void FetchSweep();
  /// When the sweep that waits is to be published.
  Clock::time_point DueTime();
  void PublishSweep();

  std::string channel_;
  Bus& bus_;
  std::unique_ptr<LidarSource> source_;
  Pacer pacer_;
  Clock::time_point next_;                                       ///< When Step has something to do.
  std::optional<TimedCloud> waiting_;                            ///< Fetched, but not due yet.
  std::optional<std::chrono::microseconds> steady_minus_sweep_;  ///< For SweepPace::kTheirTimes.
  std::int32_t seq_ = 0;
  bool is_done_ = false;
};

}  // namespace voqcal
