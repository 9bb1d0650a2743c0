#include "common/output_file.hpp"

#include <stdexcept>

#include <system_error>

namespace voqcal {

void OutputFile::Prepare() const {
  if (std::filesystem::is_directory(path))
    throw std::runtime_error(path.string() + ": is a folder");
  if (!is_forced && std::filesystem::exists(path)) {
    throw std::runtime_error(path.string() + ": is there already (--force overwrites it)");
  }
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error(folder.string() + ": cannot make the folder: " + error.message());
  }
}

CLI::Option* AddOutputFile(CLI::App* app, const std::string& what, OutputFile* file) {
  CLI::Option* out = app->add_option(
      "--out", file->path, what + "; folders are made if missing, a file that is there is refused");
  app->add_flag("--force", file->is_forced, "Overwrite the file if it is there");
  return out;
}

}  // namespace voqcal
