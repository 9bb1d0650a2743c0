#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/simulation/guided_board.hpp"
#include "core/simulation/simulation.hpp"
#include "lidar_driver/lidar_source.hpp"
#include "messaging/bus.hpp"
#include "voqcal/next_pose_t.hpp"

namespace voqcal {

/// The simulator with a board that follows NEXT_POSE. Where the board goes is decided here, half a
/// second ahead, and said as SIMULATED_BOARD before each sweep.
class GuidedLidarSource : public LidarSource {
 public:
  /// @param bus  borrowed; must outlive the source.
  GuidedLidarSource(const Rig& rig, Bus* bus);

  std::optional<TimedCloud> Next() override;
  bool HasEnded() const override { return has_ended_; }
  std::string State() const override;

 private:
  void Follow(const next_pose_t& message);

  SimulationOptions options_;
  Simulation simulation_;
  GuidedBoard board_;
  double rate_hz_;
  std::string channel_;
  Bus& bus_;
  std::int64_t num_sweeps_ = 0;
  bool has_ended_ = false;
};

}  // namespace voqcal
