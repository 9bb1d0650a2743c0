#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace voqcal {

/// True if `a` comes before `b` as people number files: pose2 before pose10, pose2 before pose02.
bool IsNaturallyLess(std::string_view a, std::string_view b);

/// The files of a folder (not of its subfolders) that have one of the extensions (".png", in any
/// case), in natural order of their names.
/// @throws std::runtime_error naming the folder if it is missing, unreadable or has no such file.
std::vector<std::filesystem::path> FilesInNaturalOrder(const std::filesystem::path& folder,
                                                       const std::vector<std::string>& extensions);

}  // namespace voqcal
