#pragma once

#include <filesystem>
#include <optional>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// A camera's intrinsics from a file (YAML) that another program left: ROS' camera_calibration
/// (camera_matrix, distortion_coefficients), cam_lidar_calibration's camera_info.yaml (K, D), or
/// the section `camera` of a rig file.
/// @throws std::runtime_error naming file, key and rule.
CameraModel ReadCameraFile(const std::filesystem::path& path);

/// Such a file within a session's folder, by the names that these programs give it: camera.yaml,
/// camera_info.yaml, ost.yaml.
std::optional<std::filesystem::path> FindCameraFile(const std::filesystem::path& session);

}  // namespace voqcal
