#pragma once

#include <filesystem>
#include <optional>

#include "rig/rig.hpp"

namespace voqcal {

/// Where a session's files go: `given`, or logs/<rig's name> below the working directory.
inline std::filesystem::path SessionFolder(const std::optional<std::filesystem::path>& given,
                                           const Rig& rig) {
  return given.value_or(std::filesystem::path("logs") / rig.name);
}

}  // namespace voqcal
