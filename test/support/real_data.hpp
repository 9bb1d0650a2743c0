#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace voqcal::test {

/// The folder of real data: VOQCAL_DATA, or ../shared/data beside the source tree; nothing if this
/// machine has none (tests then skip, visibly).
/// @throws std::runtime_error if VOQCAL_DATA names a folder that is not there.
inline std::optional<std::filesystem::path> RealDataFolder() {
  if (const char* named = std::getenv("VOQCAL_DATA")) {
    if (!std::filesystem::is_directory(named)) {
      throw std::runtime_error("VOQCAL_DATA is not a folder: " + std::string(named));
    }
    return named;
  }
  const auto beside = std::filesystem::path(VOQCAL_SOURCE_DIR).parent_path() / "shared" / "data";
  if (std::filesystem::is_directory(beside)) return beside;
  return std::nullopt;
}

}  // namespace voqcal::test
