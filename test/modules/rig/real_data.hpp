#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>

namespace voqcal::test {

/// The folder of real recordings: VOQCAL_DATA if that is set (it must then exist), else
/// ../shared/data beside the sources; nothing where neither is.
inline std::optional<std::filesystem::path> RealData() {
  const char* named = std::getenv("VOQCAL_DATA");
  const std::filesystem::path folder =
      named != nullptr ? named : std::filesystem::path(VOQCAL_SOURCE_DIR) / "../shared/data";
  if (std::filesystem::is_directory(folder)) return folder;
  if (named != nullptr) throw std::runtime_error("VOQCAL_DATA names no folder: " + folder.string());
  return std::nullopt;
}

}  // namespace voqcal::test
