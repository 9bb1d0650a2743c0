#pragma once

#include <filesystem>
#include <string>

namespace voqcal {

/// Checks a PCD file's header against its fields and the bytes (or lines) that follow, before PCL
/// sees it: PCL 1.13 trusts the header, allocates what it claims and reads beyond short files.
/// @throws std::runtime_error naming the file (with the line, in text) and what is wrong.
void CheckPcd(const std::filesystem::path& path, const std::string& contents);

/// The same for a PLY file.
void CheckPly(const std::filesystem::path& path, const std::string& contents);

}  // namespace voqcal
