#pragma once

#include <string>

#include "voqcal/rig_extrinsics_t.hpp"

namespace voqcal {

/// A line for each pair of a rig: its samples, how well the tree knows it, its verdict or why there
/// is none; then the tree's verdict, and which pair to show the board to next.
std::string TableOfPairs(const rig_extrinsics_t& rig);

}  // namespace voqcal
