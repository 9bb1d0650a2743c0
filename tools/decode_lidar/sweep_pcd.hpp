#pragma once

#include <string>

#include "core/lidar_packets/sweep_assembler.hpp"

namespace voqcal {

/// A sweep as a binary PCD file: x y z (m), intensity, ring, time (s after the sweep's begin) and
/// return_number (1: the nearest of its beam's echoes). A comment has the begin's utime.
std::string SweepPcd(const TimedSweep& sweep);

}  // namespace voqcal
