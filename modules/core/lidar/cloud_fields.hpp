#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// Where a field stands among `names`, by any name that drivers and programs give it, in letters of
/// either size: "intensity" is also reflectivity or i, "ring" channel or line, "time" t or
/// timestamp. Nothing if it is not there.
///
/// @param field  "x", "y", "z", "intensity", "ring", "time" or "return_number".
std::optional<std::size_t> FindField(const std::vector<std::string>& names, std::string_view field);

/// Gives each point its ring. Where no beam returned, drivers write NaN, -1 or whatever was there:
/// not looked at. Anything but a whole number from 0 to 65535 elsewhere is no ring, and the cloud
/// one without rings.
///
/// @param rings  as they were read, one for each point of the cloud.
void SetRings(const std::vector<double>& rings, PointCloud* cloud);

/// Gives each point its number among its beam's echoes. Anything but a whole number from 0 to 255
/// where a beam returned is none, and the cloud one without such numbers.
///
/// @param numbers  as they were read, one for each point of the cloud.
void SetReturnNumbers(const std::vector<double>& numbers, PointCloud* cloud);

/// Gives each point its time. What the numbers count (seconds to nanoseconds) is told by their
/// range, as sweeps last 4 ms to 2.5 s; numbers far from 0 are of some clock: of the stamp's, if
/// they are within 10 s of it, else counted from the first. The cloud has no times if they are
/// none.
///
/// @param times  as they were read, one for each point of the cloud.
/// @param stamp_s  of the cloud, if it has one: its times count from there.
void SetTimes(const std::vector<double>& times,
              PointCloud* cloud,
              std::optional<double> stamp_s = std::nullopt);

}  // namespace voqcal
