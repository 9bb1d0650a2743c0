#pragma once

#include <filesystem>
#include <string>

#include "core/camera/camera_model.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// A rig file's text with this camera in it: values of the section `camera` are replaced where they
/// stand, what is missing is added, and all else, comments too, is left as it is.
/// @throws std::runtime_error if the section is written in braces or in another way that lines do
///     not tell.
std::string RigWithCamera(const std::string& rig_text, const CameraModel& camera);

/// @param rig_text  the file's that says `rig`.
/// @throws std::runtime_error naming each key with a path that is meant beside the rig file, and
///     would be another in a copy at `copy_path`.
void RequireSamePaths(const Rig& rig,
                      const std::string& rig_text,
                      const std::filesystem::path& copy_path);

}  // namespace voqcal
