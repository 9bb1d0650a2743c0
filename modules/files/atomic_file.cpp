#include "files/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace voqcal {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const fs::path& path, const std::string& what, int error_number) {
  throw std::runtime_error(path.string() + ": " + what + ": " + std::strerror(error_number));
}

/// A file descriptor that is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return number_; }
  bool is_open() const { return number_ >= 0; }

  /// Some file systems tell of a full disk only here.
  bool Close() { return ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

/// A file that is removed at the end of its scope unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const fs::path& path() const { return path_; }

  bool RenameTo(const fs::path& target) {
    if (std::rename(path_.c_str(), target.c_str()) != 0) return false;
    path_.clear();
    return true;
  }

 private:
  fs::path path_;
};

bool WriteAll(int descriptor, std::string_view contents) {
  while (!contents.empty()) {
    const ssize_t num_written = ::write(descriptor, contents.data(), contents.size());
    if (num_written < 0 && errno == EINTR) continue;
    if (num_written < 0) return false;
    contents.remove_prefix(static_cast<std::size_t>(num_written));
  }
  return true;
}

fs::path FolderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void SyncFolder(const fs::path& path) {
  const Descriptor folder(::open(FolderOf(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // Some network file systems cannot sync a folder (EINVAL): the file itself is safe there.
  if (!folder.is_open() || (::fsync(folder.get()) != 0 && errno != EINVAL)) {
    Fail(path, "written, but its folder cannot be synced", errno);
  }
}

}  // namespace

std::string ReadWholeFile(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) Fail(path, "cannot be read", EISDIR);
  std::ifstream file(path, std::ios::binary);
  if (!file) Fail(path, "cannot be read", errno);
  std::string contents{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) Fail(path, "cannot be read", errno);
  return contents;
}

void WriteFileAtomically(const fs::path& path, std::string_view contents, FileReaders readers) {
  const fs::path temporary_path =
      FolderOf(path) / ("." + path.filename().string() + "." + std::to_string(::getpid()) + ".tmp");
  // Left by a process that was killed, perhaps; a new one is open to nobody else.
  ::unlink(temporary_path.c_str());
  const mode_t mode = readers == FileReaders::kOwnerOnly ? 0600 : 0666;
  Descriptor file(::open(temporary_path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
  if (!file.is_open()) Fail(path, "cannot be written", errno);
  TemporaryFile temporary(temporary_path);
  if (!WriteAll(file.get(), contents) || ::fsync(file.get()) != 0 || !file.Close()) {
    Fail(path, "cannot be written", errno);
  }
  if (!temporary.RenameTo(path)) Fail(path, "cannot be replaced", errno);
  SyncFolder(path);
}

}  // namespace voqcal
