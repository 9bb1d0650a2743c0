#pragma once

#include <cstddef>

#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// Removes each return that lies exactly where an earlier one does: a lidar of two returns gives
/// the one echo of a beam twice, and what counts points would take it for two. Beams without a
/// return stay.
/// @return how many went.
std::size_t DropRepeatedPoints(PointCloud* cloud);

}  // namespace voqcal
