#pragma once

#include <cstdint>

#include "core/lidar/point_cloud.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {

/// Packs a cloud: x y z FLOAT32, then what the cloud carries of intensity FLOAT32, ring UINT16,
/// time FLOAT32, return_number UINT8; little-endian, one row. Exact.
pointcloud2_t ToMessage(const PointCloud& cloud_lidar_m, std::int64_t utime, std::int32_t seq);

/// Reads any driver's cloud: fields in any order, of any number type, of either byte order, with
/// rows padded or not.
/// - "x" "y" "z": metres; they must be there.
/// - "intensity", "ring", "time" and "return_number" by any usual name
///   (core/lidar/cloud_fields.hpp).
/// - times: FLOAT32 and FLOAT64 are seconds, integers nanoseconds; values above 1e8 s count from
///   the epoch, others from utime.
/// - a return that is there twice is read once (DropRepeatedPoints).
///
/// @throws MessageError with the cause, if sizes, offsets or counts contradict each other, a
///     coordinate is missing, or a ring is no number from 0 to 65535.
PointCloud FromMessage(const pointcloud2_t& message);

}  // namespace voqcal
