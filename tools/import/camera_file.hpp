#pragma once

#include <filesystem>
#include <string>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// The intrinsics of a camera that another tool calibrated: Kalibr's camchain.yaml (pinhole with
/// radtan or equidistant), ROS' camera_info YAML (camera_calibration, camera_info_manager),
/// cam_lidar_calibration's camera_info.yaml (K, D), or the section `camera` of a rig file.
///
/// @param name  of the camera in a camchain; empty: the only one, or cam0.
/// @throws std::runtime_error naming file, line and key, and how to convert what is not known here.
CameraModel ReadCameraFile(const std::filesystem::path& path, const std::string& name = "");

}  // namespace voqcal
