#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "rig/rig.hpp"

namespace voqcal {

struct AcfrImportOptions {
  double rate_hz = 2.0;             ///< Poses a second when the log is replayed.
  bool is_paired_by_order = false;  ///< Not by the numbers or times in the names.
};

struct ImportedFrames {
  std::size_t num_clouds = 0;
  std::size_t num_images = 0;
  std::string text;                 ///< "18 clouds (1 left out) and 18 images".
  std::string pairing;              ///< By what clouds and images were paired, for people.
  std::vector<std::string> doubts;  ///< Why hardly a sample will come of it, and what to do.
};

/// @throws std::runtime_error naming the folder of a session that is missing or empty.
void RequireAcfrSession(const std::filesystem::path& folder, const AcfrImportOptions& options);

/// Writes a session of cam_lidar_calibration (images/poseN.png, pcd/poseN_full.pcd) as a recording:
/// LIDAR_POINTS, CAMERA_INFO and CAMERA_IMAGE on the rig's channels, with progress on the terminal.
/// A cloud or an image that cannot be read is left out and named.
/// @throws std::runtime_error naming the folder that is missing or empty, or what makes the pairing
///     doubtful.
ImportedFrames ImportAcfrSession(const std::filesystem::path& folder,
                                 const Rig& rig,
                                 const AcfrImportOptions& options,
                                 const std::filesystem::path& log);

}  // namespace voqcal
