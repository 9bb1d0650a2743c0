#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "camera_driver/camera_source.hpp"
#include "core/simulation/simulation.hpp"
#include "messaging/bus.hpp"
#include "voqcal/simulated_board_t.hpp"

namespace voqcal {

/// The simulator with the board where SIMULATED_BOARD says that it is; waits until that is decided.
class GuidedCameraSource : public CameraSource {
 public:
  /// @param bus  borrowed; must outlive the source.
  GuidedCameraSource(const Rig& rig, Bus* bus);

  bool IsReady() const override;
  std::optional<TimedImage> Next() override;
  bool HasEnded() const override { return has_ended_; }
  std::string State() const override;

 private:
  std::int64_t NextUtime() const;

  SimulationOptions options_;
  Simulation simulation_;
  double rate_hz_;
  int jpeg_quality_;
  std::optional<simulated_board_t> board_;
  std::int64_t num_images_ = 0;
  bool has_ended_ = false;
};

}  // namespace voqcal
