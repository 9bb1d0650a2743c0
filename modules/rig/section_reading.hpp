#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "files/option_section.hpp"

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
                     OptionSection* section,
                     std::filesystem::path* path,
                     const std::string& meaning) {
  std::string text;
  section->Read(key, &text, meaning);
  *path = Beside(rig_path, text);
}

/// Words for OptionSection::ReadOneOf: each value by its name.
template <typename Enum>
std::vector<std::pair<std::string, Enum>> ByName(const std::vector<Enum>& values) {
  std::vector<std::pair<std::string, Enum>> words;
  for (const Enum value : values) words.emplace_back(ToString(value), value);
  return words;
}

/// Reads nothing more of a section: what is left over or does not fit together becomes an error.
template <typename Options>
void CheckAndClose(const Options& options, OptionSection* section) {
  section->AddProblems(options.Problems());
  section->RefuseUnknownKeys();
}

}  // namespace voqcal
