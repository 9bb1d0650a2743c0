#pragma once

#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "files/yaml_reader.hpp"

namespace voqcal {

/// Every key of a rig file: what must be given by an example, all else by its default.
std::vector<YamlDocument::KnownKey> DefaultRigKeys();

/// The camera of that example.
CameraModel ExampleCamera();

/// The same as a rig file that says what each means.
std::string DefaultRigText();

}  // namespace voqcal
