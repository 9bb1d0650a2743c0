#include "files/sha256.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <openssl/evp.h>

namespace voqcal {
namespace {

void Require(bool is_done) {
  if (!is_done) throw std::runtime_error("SHA-256: libcrypto refuses to compute it");
}

}  // namespace

struct Sha256::Context {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> evp{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  Require(context_->evp != nullptr &&
          EVP_DigestInit_ex(context_->evp.get(), EVP_sha256(), nullptr) == 1);
}

Sha256::~Sha256() = default;

void Sha256::Add(const void* bytes, std::size_t num_bytes) {
  Require(EVP_DigestUpdate(context_->evp.get(), bytes, num_bytes) == 1);
}

std::string Sha256::Hex() const {
  const Context copy;  // finishing ends a context: more may be added to this one
  Require(copy.evp != nullptr && EVP_MD_CTX_copy_ex(copy.evp.get(), context_->evp.get()) == 1);
  std::array<unsigned char, 32> digest{};
  Require(EVP_DigestFinal_ex(copy.evp.get(), digest.data(), nullptr) == 1);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (const unsigned char byte : digest) {
    hex += kDigits[byte >> 4U];
    hex += kDigits[byte & 15U];
  }
  return hex;
}

std::string Sha256OfBytes(std::string_view bytes) {
  Sha256 hash;
  hash.Add(bytes.data(), bytes.size());
  return hash.Hex();
}

std::string Sha256OfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const auto fail = [&path] {
    throw std::runtime_error(path.string() + ": cannot be read: " + std::strerror(errno));
  };
  if (!file) fail();
  Sha256 hash;
  std::array<char, 65536> piece{};
  while (file) {
    file.read(piece.data(), piece.size());
    hash.Add(piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) fail();
  return hash.Hex();
}

}  // namespace voqcal
