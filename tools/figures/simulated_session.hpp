#pragma once

#include <cstdint>
#include <vector>

#include "core/board/board_sample.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// The simulation of `rig` with the faults of a real VLP-16: all ranges 20 mm long, dark squares
/// 15 mm longer than bright ones, rings apart by up to about 30 mm (1 sigma 8 mm).
SimulationOptions FaultySimulation(const Rig& rig, int num_poses, std::uint32_t seed);

/// The samples that the detectors find in one image and one sweep of each stop, and that agree with
/// one another.
std::vector<BoardSample> SimulateSession(const Rig& rig, const SimulationOptions& simulation);

}  // namespace voqcal
