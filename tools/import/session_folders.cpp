#include "import/session_folders.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <system_error>

#include "rig/frame_folder.hpp"

namespace voqcal {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> EntriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;  // a missing folder is told by who reads it
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().front() != '.') entries.push_back(entry.path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

bool HasFiles(const fs::path& folder, const std::vector<std::string>& endings) {
  const std::vector<fs::path> entries = EntriesOf(folder);
  return std::any_of(entries.begin(), entries.end(), [&](const fs::path& path) {
    return std::count(endings.begin(), endings.end(), path.extension().string()) > 0;
  });
}

fs::path FolderOf(const fs::path& session,
                  const char* usual_name,
                  const char* what,
                  const std::vector<std::string>& endings) {
  const fs::path usual = session / usual_name;
  if (fs::is_directory(usual)) return usual;
  if (HasFiles(session, endings)) return session;
  std::vector<fs::path> found;
  for (const fs::path& entry : EntriesOf(session)) {
    if (fs::is_directory(entry) && HasFiles(entry, endings)) found.push_back(entry);
  }
  if (found.size() > 1) {
    throw std::runtime_error(session.string() + ": several folders have " + what + " (" +
                             found[0].filename().string() + ", " + found[1].filename().string() +
                             (found.size() > 2 ? ", ..." : "") + "): call the one that is meant " +
                             usual_name);
  }
  return found.empty() ? usual : found.front();
}

}  // namespace

SessionFolders FindSessionFolders(const fs::path& session) {
  return {FolderOf(session, "pcd", "clouds", kCloudEndings),
          FolderOf(session, "images", "images", kImageEndings)};
}

}  // namespace voqcal
