#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "files/option_section.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Reads `camera`: the intrinsics, and where the lidar is if anyone knows. With `lens`, the
/// camera's numbers may be missing.
void ReadCamera(OptionSection* top,
                CameraModel* camera,
                std::optional<Eigen::Isometry3d>* T_camera_lidar_guess,
                LensInRig* lens);

}  // namespace voqcal
