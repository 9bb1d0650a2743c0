#include "dashboard/access.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <boost/asio/ip/address.hpp>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files/atomic_file.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kTokenBytes = 32;

bool IsToken(std::string_view text) {
  return text.size() == 2 * kTokenBytes &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool IsOwnersOnly(const std::filesystem::path& file) {
  struct stat status {};
  if (lstat(file.c_str(), &status) != 0) return false;
  return S_ISREG(status.st_mode) && status.st_uid == geteuid() && (status.st_mode & 077U) == 0;
}

// "http://127.0.0.1:8765/TOKEN/"
std::string TokenOf(const std::string& address) {
  const std::size_t end = address.rfind('/');
  if (end == std::string::npos || end < 2 * kTokenBytes) return "";
  return address.substr(end - 2 * kTokenBytes, 2 * kTokenBytes);
}

// "[::1]:8765" and "localhost:8765" without the port and the brackets.
std::string_view WithoutPort(std::string_view host) {
  if (!host.empty() && host.front() == '[') {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? std::string_view() : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

/// Host names mean the same in either case (RFC 4343), and browsers send small letters.
std::string InLowerCase(std::string_view name) {
  std::string lower(name);
  for (char& letter : lower) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return lower;
}

}  // namespace

std::string NewToken() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (getentropy(bytes.data(), bytes.size()) != 0) {
    throw std::runtime_error(std::string("no random numbers: ") + std::strerror(errno));
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : bytes) {
    token += kDigits[byte >> 4U];
    token += kDigits[byte & 15U];
  }
  return token;
}

std::string TokenOfSession(const std::filesystem::path& address_file) {
  if (!IsOwnersOnly(address_file)) return NewToken();
  std::ifstream file(address_file);
  std::string address;
  std::getline(file, address);
  std::string token = TokenOf(address);
  return IsToken(token) ? token : NewToken();
}

void SaveAddresses(const std::filesystem::path& address_file, const std::string& lines) {
  WriteFileAtomically(address_file, lines + "\n", FileReaders::kOwnerOnly);
}

bool IsSameSecret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return difference == 0;
}

bool IsOwnHost(std::string_view host, std::string_view host_name) {
  const std::string name = InLowerCase(WithoutPort(host));
  if (name.empty()) return false;
  if (name == "localhost" || name == InLowerCase(host_name)) return true;
  boost::system::error_code error;
  boost::asio::ip::make_address(name, error);
  return !error;
}

bool IsOwnOrigin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return origin.substr(0, kScheme.size()) == kScheme && origin.substr(kScheme.size()) == host;
}

}  // namespace voqcal
