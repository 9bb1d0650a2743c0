#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace voqcal {

/// What a file is that could not be read, and the remedy, where its first bytes tell: "is
/// compressed: unpack it first (gunzip)". Empty where they do not.
std::string ForeignFileText(std::string_view first_bytes);

/// The same of a file.
std::string ForeignFileText(const std::filesystem::path& path);

}  // namespace voqcal
