#pragma once

#include <string>

#include "rig/rig.hpp"
#include "rig/sensor_entries.hpp"

namespace voqcal {

/// The channels of a file of one lidar and one camera.
void ReadChannels(OptionSection* top, const std::string& prefix, Channels* channels);

/// The channels of one pair of sensors that are given by name. A sensor's end with its name, those
/// of a pair with both, unless the sensor's own section `channels` names them. Those of all sensors
/// are read: no two may be the same.
void ReadChannels(OptionSection* top,
                  const std::string& prefix,
                  const PairOfEntries& pair,
                  SensorEntries* entries,
                  Channels* channels);

}  // namespace voqcal
