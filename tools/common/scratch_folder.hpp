#pragma once

#include <filesystem>

namespace voqcal {

/// A folder made for one run beside where its results will go, and removed with all that is still
/// in it; also when SIGINT (Ctrl-C), SIGTERM or SIGHUP ends the process. One at a time, but for
/// others within it.
class ScratchFolder {
 public:
  /// @param beside  the folder or file beside which it is made; its parent folders are made if
  /// missing.
  /// @throws std::runtime_error naming the folder and the cause.
  explicit ScratchFolder(const std::filesystem::path& beside);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool is_outermost_ = false;
  std::filesystem::path parents_end_;  // the nearest folder above that was there before
};

}  // namespace voqcal
