#pragma once

#include <filesystem>

#include "core/lidar/point_cloud.hpp"

namespace voqcal {

/// Reads one sweep from a PCD (ascii, binary, binary_compressed) or PLY file, told by its name.
/// Fields: x y z (metres, lidar frame), and if present intensity, ring (0 to 65535) and time
/// (seconds after the sweep's begin). Others are not looked at. Points with NaN are kept.
///
/// @throws std::runtime_error naming the file and the cause: missing, empty, cut short, no cloud,
///     no x y z, numbers that are none.
PointCloud ReadPointCloud(const std::filesystem::path& path);

}  // namespace voqcal
