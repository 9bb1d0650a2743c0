#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace voqcal {

/// SHA-256 (FIPS 180-4) as 64 lower-case hexadecimal digits.
std::string Sha256OfBytes(std::string_view bytes);

/// The same of a file's bytes, read piece by piece.
/// @throws std::runtime_error naming the file if it cannot be read.
std::string Sha256OfFile(const std::filesystem::path& path);

}  // namespace voqcal
