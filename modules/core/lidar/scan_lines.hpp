#pragma once

#include <cstdint>
#include <vector>

#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// The scan line of each point, told by geometry: a spinning lidar's lines are cones about its
/// axis, which is one of the frame's. Counted from the lowest; 0 for points without a return.
///
/// @return one for each point; empty if the rays do not lie on a few cones that are clearly apart.
std::vector<std::uint16_t> ScanLinesOf(const PointCloud& cloud_lidar_m);

/// Whether the cloud's rings are scan lines: more than one, and each a cone about one of the
/// frame's axes. A field that is constant, or counts something else, is none.
bool AreRingsScanLines(const PointCloud& cloud_lidar_m);

}  // namespace voqcal
