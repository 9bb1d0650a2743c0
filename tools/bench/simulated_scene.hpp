#pragma once

#include "core/simulation/simulation.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {

/// A simulated rig with the board, the camera and about the mounting of the real session.
inline const Simulation& BenchSimulation() {
  static const Simulation simulation = [] {
    SimulationOptions options;
    options.T_camera_lidar = test::TestExtrinsic();
    return Simulation(options, test::TestBoard(), test::TestCamera());
  }();
  return simulation;
}

}  // namespace voqcal
