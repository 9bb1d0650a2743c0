#pragma once

#include "files/option_section.hpp"
#include "rig/rig.hpp"
#include "rig/sensor_entries.hpp"

namespace voqcal {

/// The section simulation: of one lidar and one camera all that is simulated, of several the world
/// that they share.
void ReadSimulation(OptionSection* top, SimulationOptions* options);

/// Rig::simulated_rig, if the file's sensors are several and the simulator's. All are, or none:
/// there is one world, with one board. `rig` has its `simulation` and what is said of `pair`
/// already.
void ReadSimulatedRig(OptionSection* top,
                      const PairOfEntries& pair,
                      SensorEntries* entries,
                      Rig* rig);

}  // namespace voqcal
