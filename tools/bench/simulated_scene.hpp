#pragma once

#include "core/simulation/simulation.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {

/// A simulated rig with the board, the camera and about the mounting of the real session.
inline Simulation BenchSimulation(ScanPattern pattern = ScanPattern::kVlp16) {
  SimulationOptions options;
  options.T_camera_lidar = test::TestExtrinsic();
  options.scan.pattern = pattern;
  return Simulation(options, test::TestBoard(), test::TestCamera());
}

}  // namespace voqcal
