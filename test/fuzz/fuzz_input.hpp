#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "support/temporary_folder.hpp"

namespace voqcal::fuzz {

/// Takes an input apart from the front; what is not there reads as zero.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t Byte() {
    if (size_ == 0) return 0;
    --size_;
    return *data_++;
  }
  int Word() {
    const int high = Byte();
    return high << 8 | Byte();
  }
  void Skip(std::size_t num_bytes) {
    data_ += num_bytes;
    size_ -= num_bytes;
  }

  const std::uint8_t* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::string Text() const { return {reinterpret_cast<const char*>(data_), size_}; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// A folder in memory where there is one: thousands of files a second.
inline const test::TemporaryFolder& Folder() {
  if (std::filesystem::is_directory("/dev/shm")) setenv("TMPDIR", "/dev/shm", 0);
  static const test::TemporaryFolder folder;
  return folder;
}

/// The input as a file, for readers that take a path. One file a name, written over each time.
inline std::filesystem::path AsFile(const Input& input, const std::string& name) {
  return Folder().Write(name, input.Text());
}

/// Refusing an input is an ordinary answer; only what no reader may do ends the program.
template <typename Read>
void Tolerate(const Read& read) {
  try {
    read();
  } catch (const std::runtime_error&) {
  }
}

}  // namespace voqcal::fuzz
