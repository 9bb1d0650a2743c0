#pragma once

#include <filesystem>

#include "files/option_section.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// The section lidar_driver. Relative paths are relative to the folder of `rig_path`.
void ReadLidarDriver(OptionSection* top,
                     const std::filesystem::path& rig_path,
                     LidarDriverOptions* options,
                     LidarSensorOptions* sensor);

/// The section camera_driver.
void ReadCameraDriver(OptionSection* top,
                      const std::filesystem::path& rig_path,
                      CameraDriverOptions* options);

}  // namespace voqcal
