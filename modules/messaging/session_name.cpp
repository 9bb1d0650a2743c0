#include "messaging/session_name.hpp"

#include <cstring>

#include <climits>
#include <unistd.h>

namespace voqcal {
namespace {

bool HasFolder(const std::string& session) { return !session.empty() && session.back() != ':'; }

bool IsWithin(const std::string& inner, const std::string& outer) {
  return inner.compare(0, outer.size() + 1, outer + "/") == 0;
}

}  // namespace

std::string SessionName(const std::filesystem::path& session_dir) {
  char host[HOST_NAME_MAX + 1] = {};
  if (gethostname(host, HOST_NAME_MAX) != 0) std::strcpy(host, "unknown");
  if (session_dir.empty()) return std::string(host) + ":";
  const std::filesystem::path folder =
      weakly_canonical(absolute(session_dir));  // it may be to come
  return std::string(host) + ":" + (folder.has_filename() ? folder : folder.parent_path()).string();
}

bool MayBeOf(const std::string& own, const std::string& other) {
  if (!HasFolder(own) || !HasFolder(other)) return true;
  return own == other || IsWithin(own, other) || IsWithin(other, own);
}

}  // namespace voqcal
