#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace voqcal {

/// SHA-256 (FIPS 180-4) of bytes that come piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void Add(const void* bytes, std::size_t num_bytes);
  /// Of all that was added so far, as 64 lower-case hexadecimal digits.
  std::string Hex() const;

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// SHA-256 as 64 lower-case hexadecimal digits.
std::string Sha256OfBytes(std::string_view bytes);

/// The same of a file's bytes, read piece by piece.
/// @throws std::runtime_error naming the file if it cannot be read.
std::string Sha256OfFile(const std::filesystem::path& path);

}  // namespace voqcal
