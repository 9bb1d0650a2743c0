#pragma once

#include <string>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// A rig file's text with this camera in it: values of the section `camera` are replaced where they
/// stand, what is missing is added, and all else, comments too, is left as it is.
/// @throws std::runtime_error if the section is written in braces or in another way that lines do
///     not tell.
std::string RigWithCamera(const std::string& rig_text, const CameraModel& camera);

}  // namespace voqcal
