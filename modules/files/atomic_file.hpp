#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace voqcal {

/// The bytes of a regular file.
/// @throws std::runtime_error naming the file and the cause.
std::string ReadWholeFile(const std::filesystem::path& path);

/// Who may read a file that is written.
enum class FileReaders {
  kAsUmaskSays,
  kOwnerOnly,  ///< From the first byte on.
};

/// Writes a file whole or not at all: a temporary file beside it, synced, then renamed over it, and
/// the folder synced. After a power cut there is the old file or the new one, never a part.
///
/// @throws std::runtime_error naming the file and the cause (no such folder, no permission, disk
///     full); the old file is then as it was and nothing is left beside it.
void WriteFileAtomically(const std::filesystem::path& path,
                         std::string_view contents,
                         FileReaders readers = FileReaders::kAsUmaskSays);

}  // namespace voqcal
