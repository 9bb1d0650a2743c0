#pragma once

#include <cstddef>
#include <filesystem>

#include "rig/rig.hpp"

namespace voqcal {

struct ImportedFrames {
  std::size_t num_clouds = 0;
  std::size_t num_images = 0;
};

/// Writes a session of cam_lidar_calibration (images/poseN.png, pcd/poseN_full.pcd) as a recording:
/// LIDAR_POINTS, CAMERA_INFO and CAMERA_IMAGE on the rig's channels, with progress on the terminal.
/// @param rate_hz  poses a second when the log is replayed.
/// @throws std::runtime_error naming the folder that is missing or empty, or the file that cannot
///     be read or written.
ImportedFrames ImportAcfrSession(const std::filesystem::path& folder,
                                 const Rig& rig,
                                 double rate_hz,
                                 const std::filesystem::path& log);

}  // namespace voqcal
