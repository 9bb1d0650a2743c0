#pragma once

#include "result/rig_extrinsics.hpp"
#include "voqcal/rig_extrinsics_t.hpp"

namespace voqcal {

/// utime, revision and which samples each pair was made of are left to the caller.
rig_extrinsics_t ToMessage(const RigExtrinsics& result);

}  // namespace voqcal
