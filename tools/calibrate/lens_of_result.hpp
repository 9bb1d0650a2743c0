#pragma once

#include <filesystem>
#include <string>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// Why an extrinsic should not be used with a camera: a sentence without a full stop, with the
/// largest angle between the two lenses' rays, if the result was made with another lens. Empty if
/// it was not, or if the file does not say.
///
/// @param extrinsic  as ReadExtrinsic takes it.
/// @throws std::runtime_error naming the file, line and key of a camera that is none.
std::string LensDoubt(const std::filesystem::path& extrinsic, const CameraModel& camera);

}  // namespace voqcal
