#include "dashboard/page_files.hpp"

#include <filesystem>

#include "files/atomic_file.hpp"

namespace voqcal {

std::map<std::string, StaticFile> PageFiles() {
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  const auto folder = program.parent_path().parent_path() / "share" / "dashboard";
  if (!std::filesystem::exists(folder / "dashboard.js")) {
    return {{"",
             {"text/plain; charset=utf-8",
              "The page is missing: it is built where Node.js and its packages are installed "
              "(in the source tree: tools/setup, then tools/build).\n"}}};
  }
  return {
      {"", {"text/html; charset=utf-8", ReadWholeFile(folder / "index.html")}},
      {"dashboard.css", {"text/css; charset=utf-8", ReadWholeFile(folder / "dashboard.css")}},
      {"dashboard.js", {"text/javascript; charset=utf-8", ReadWholeFile(folder / "dashboard.js")}}};
}

}  // namespace voqcal
