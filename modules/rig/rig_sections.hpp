#pragma once

#include "files/yaml_reader.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Fills everything of `rig` that its file says; what is wrong becomes an error of `document`.
/// Folders are relative to the file of `place`. With `lens`, the camera's numbers may be missing;
/// as `plate` says, the plate's (Rig::is_plate_given).
/// @throws std::runtime_error if `place` does not tell which sensors are meant.
void ReadRigSections(const RigPlace& place,
                     YamlDocument* document,
                     Rig* rig,
                     LensInRig* lens = nullptr,
                     SensorChoice choice = SensorChoice::kPair,
                     PlateInRig plate = PlateInRig::kRequired);

/// The sensors that the file names; none if it is of one lidar and one camera. Which of them are
/// meant, the file may say where `place` does not.
/// @throws std::runtime_error naming file, line and key if those sections are wrong; if `place`
///     names a sensor that is none of them.
RigSensors ReadRigSensors(PairLine line, RigPlace* place, YamlDocument* document);

}  // namespace voqcal
