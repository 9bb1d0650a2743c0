#pragma once

#include <string>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// What the section camera of a rig file holds, a line a key, each after `indent`.
std::string CameraYaml(const CameraModel& camera, const std::string& indent);

}  // namespace voqcal
