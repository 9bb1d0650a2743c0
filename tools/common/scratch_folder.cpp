#include "common/scratch_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include <system_error>

namespace voqcal {

ScratchFolder::ScratchFolder(const std::filesystem::path& beside) {
  const std::filesystem::path absolute = std::filesystem::absolute(beside).lexically_normal();
  // "out/" has an empty file name; its folder is the one before the slash.
  const std::filesystem::path target = absolute.has_filename() ? absolute : absolute.parent_path();
  std::error_code error;
  parents_end_ = target.parent_path();
  while (!std::filesystem::exists(parents_end_, error) && parents_end_.has_relative_path()) {
    parents_end_ = parents_end_.parent_path();
  }
  std::filesystem::create_directories(target.parent_path(), error);
  if (error) {
    throw std::runtime_error(target.parent_path().string() +
                             ": cannot make the folder: " + error.message());
  }
  std::string name = target.string() + ".unfinished-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error(name + ": cannot make the folder: " + std::strerror(errno));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;  // what cannot be removed cannot be told to anyone from here
  std::filesystem::remove_all(path_, ignored);
  // remove() leaves a folder that has something in it.
  for (auto folder = path_.parent_path(); folder != parents_end_; folder = folder.parent_path()) {
    if (!std::filesystem::remove(folder, ignored)) break;
  }
}

}  // namespace voqcal
