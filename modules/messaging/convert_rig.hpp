#pragma once

#include "core/guidance/weakest_pair.hpp"
#include "result/rig_extrinsics.hpp"
#include "voqcal/next_pose_t.hpp"
#include "voqcal/rig_extrinsics_t.hpp"

namespace voqcal {

/// utime, revision and which samples each pair was made of are left to the caller.
rig_extrinsics_t ToMessage(const RigExtrinsics& result);

/// @param pair  a lidar and a camera.
/// @param next  what its guide says; null: nothing yet.
PairNeed NeedOf(const rig_pair_t& pair, const next_pose_t* next);

}  // namespace voqcal
