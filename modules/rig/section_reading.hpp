#pragma once

#include <filesystem>
#include <string>

#include "files/yaml_reader.hpp"

namespace voqcal {

/// A path of the rig file: beside the file itself, unless it is absolute.
inline std::filesystem::path Beside(const std::filesystem::path& rig_path,
                                    const std::string& path) {
  if (path.empty()) return {};
  return (rig_path.parent_path() / path).lexically_normal();
}

/// Such a path under `key`.
inline void ReadPath(const std::string& key,
                     const std::filesystem::path& rig_path,
                     YamlSection* section,
                     std::filesystem::path* path) {
  std::string text;
  section->Read(key, &text);
  *path = Beside(rig_path, text);
}

/// Reads nothing more of a section: what is left over or does not fit together becomes an error.
template <typename Options>
void CheckAndClose(const Options& options, YamlSection* section) {
  section->AddProblems(options.Problems());
  section->RefuseUnknownKeys();
}

}  // namespace voqcal
