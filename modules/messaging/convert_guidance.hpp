#pragma once

#include "core/guidance/next_pose.hpp"
#include "voqcal/next_pose_t.hpp"

namespace voqcal {

/// utime and revision are left to the caller.
next_pose_t ToMessage(const NextPose& next,
                      const GuidanceOptions& asked,
                      const BoardSpec& board,
                      const CameraModel& camera);

}  // namespace voqcal
