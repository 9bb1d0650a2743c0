#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/sensor_network/common_boards.hpp"
#include "core/simulation/rig_simulation.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// What all sensors of a rig saw of the board at the stops of one session.
struct RigSession {
  /// By stop, then by sensor; null: it did not see the board.
  std::vector<std::vector<std::optional<LidarBoard>>> lidars;
  std::vector<std::vector<std::optional<CameraBoard>>> cameras;

  /// The stops at which both see it.
  std::vector<BoardSample> Samples(std::size_t lidar, std::size_t camera) const;
  std::vector<CommonBoard> CommonBoards(std::size_t from_camera, std::size_t to_camera) const;
};

/// Sweeps through the detector; corners by projection with noise of 0.1 px, and what the camera
/// makes of them.
/// @param rig  for the board and the detectors' options.
RigSession SimulateRigSession(const RigSimulationOptions& simulation, const Rig& rig);

}  // namespace voqcal
