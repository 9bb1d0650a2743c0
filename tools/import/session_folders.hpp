#pragma once

#include <filesystem>

namespace voqcal {

/// Where a session keeps its clouds and its images; one folder may have both.
struct SessionFolders {
  std::filesystem::path clouds;
  std::filesystem::path images;
};

/// The folders pcd and images, if they are there; else what has such files: the session's folder
/// itself, or the only one within it. Where none has, pcd and images all the same: who reads them
/// says what is missing.
/// @throws std::runtime_error naming them, if there are several.
SessionFolders FindSessionFolders(const std::filesystem::path& session);

}  // namespace voqcal
