#pragma once

#include "core/guidance/next_pose.hpp"
#include "files/option_section.hpp"

namespace voqcal {

/// Reads `pose_guide`, if it is there: options not given keep their values.
void ReadPoseGuide(OptionSection* top, GuidanceOptions* options);

}  // namespace voqcal
