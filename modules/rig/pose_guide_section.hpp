#pragma once

#include "core/guidance/next_pose.hpp"
#include "files/yaml_reader.hpp"

namespace voqcal {

/// Reads `pose_guide`, if it is there: options not given keep their values.
void ReadPoseGuide(YamlSection* top, GuidanceOptions* options);

}  // namespace voqcal
