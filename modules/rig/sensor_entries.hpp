#pragma once

#include <string>
#include <vector>

#include "files/option_section.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// One sensor of a rig file that has them by name: under `lidars` or `cameras`.
struct SensorEntry {
  std::string name;
  OptionSection section;
};

/// All of them, in the file's order; none in a file of one lidar and one camera.
struct SensorEntries {
  std::vector<SensorEntry> lidars;
  std::vector<SensorEntry> cameras;

  bool AreGiven() const { return !lidars.empty() || !cameras.empty(); }
  RigSensors Names() const;
};

/// Names that are none, a sensor twice, two pairs of one name, and the sections of a file of one
/// lidar and one camera beside them become errors of the document.
SensorEntries ReadSensorEntries(OptionSection* top);

/// @throws std::runtime_error with one line if `place` names a sensor that is none of these.
void RequireNames(const RigPlace& place, const RigSensors& sensors);

/// The two that a rig is made of.
struct PairOfEntries {
  SensorEntry* lidar = nullptr;
  SensorEntry* camera = nullptr;
};

/// Those that `place` names; the only lidar and the only camera need no name. What `choice` is not
/// about may be any: the first serves, where none is named.
/// @throws std::runtime_error with one line, unless one lidar and one camera are left.
PairOfEntries ChoosePair(const RigPlace& place, SensorChoice choice, SensorEntries* entries);

}  // namespace voqcal
