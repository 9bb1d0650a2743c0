#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/camera/camera_model.hpp"
#include "dashboard/server.hpp"

namespace voqcal {

/// The result file as it is, and in every form that other programs take (rig/extrinsic_text.hpp),
/// by name: "extrinsic.yaml", "extrinsic_ros.txt", ... A form that this camera has none of is left
/// out.
/// @param samples_sha256  hash of the samples that it must be made from.
/// @throws std::runtime_error if the file cannot be read or is made from other samples.
std::map<std::string, StaticFile> ExportsOf(const std::filesystem::path& result_file,
                                            const std::string& samples_sha256,
                                            const CameraModel& camera);

}  // namespace voqcal
