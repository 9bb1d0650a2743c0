#pragma once

#include <filesystem>
#include <string>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// A rig file's text with this camera in it: values of the section `camera` are replaced where they
/// stand, what is missing is added, and all else, comments too, is left as it is.
/// @param name  of a camera under `cameras`, whose section it is; empty in a file of one camera.
/// @throws std::runtime_error if the section is written in braces or in another way that lines do
///     not tell.
std::string RigWithCamera(const std::string& rig_text,
                          const CameraModel& camera,
                          const std::string& name = "");

/// @throws std::runtime_error naming each key with a path, of any sensor, that is meant beside the
///     rig file, and would be another in a copy at `copy_path`.
void RequireSamePaths(const std::filesystem::path& rig_file,
                      const std::filesystem::path& copy_path);

}  // namespace voqcal
