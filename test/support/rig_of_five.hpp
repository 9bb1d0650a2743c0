#pragma once

#include "core/board/board_spec.hpp"
#include "core/simulation/rig_simulation.hpp"

namespace voqcal::test {

/// Two lidars of different patterns and three cameras of different lenses: a VLP-16 that looks all
/// round (`roof`), a raster of 110 degrees ahead, tilted (`bumper`); `front` (fisheye) and `left`
/// (plumb bob) share views with both and with each other, `rear` (rational) with `roof` alone.
RigSimulationOptions RigOfFive();

}  // namespace voqcal::test
