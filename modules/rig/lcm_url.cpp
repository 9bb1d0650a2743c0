#include "rig/lcm_url.hpp"

#include <cstdint>
#include <sstream>

#include <arpa/inet.h>

#include "files/number_text.hpp"

namespace voqcal {
namespace {

/// "scheme://host:port?option=value&...", as far as each part is there.
struct UrlParts {
  std::string scheme;
  std::string host;
  std::string port;
  bool has_port = false;
  std::string options;
};

UrlParts Split(const std::string& url) {
  UrlParts parts;
  const std::size_t scheme_end = url.find("://");
  if (scheme_end == std::string::npos) return parts;
  parts.scheme = url.substr(0, scheme_end);
  std::string rest = url.substr(scheme_end + 3);
  const std::size_t question = rest.find('?');
  if (question != std::string::npos) parts.options = rest.substr(question + 1);
  rest = rest.substr(0, question);
  const std::size_t colon = rest.find(':');
  parts.has_port = colon != std::string::npos;
  parts.host = rest.substr(0, colon);
  if (parts.has_port) parts.port = rest.substr(colon + 1);
  return parts;
}

bool IsWithin(const std::string& text, std::uint32_t min, std::uint32_t max) {
  std::uint32_t value = 0;
  return ParseNumber(text, &value) && value >= min && value <= max;
}

bool IsMulticast(const std::string& address) {
  in_addr parsed{};
  return inet_pton(AF_INET, address.c_str(), &parsed) == 1 && IN_MULTICAST(ntohl(parsed.s_addr));
}

// Those of LCM 1.3's lcm_udpm.c, which passes over any other.
std::string UdpmOptionsProblem(const std::string& options) {
  constexpr std::uint32_t kMaxTtl = 255;
  constexpr std::uint32_t kMaxBytes = 2147483647;
  std::istringstream all(options);
  for (std::string option; std::getline(all, option, '&');) {
    const std::size_t equals = option.find('=');
    const std::string name = option.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : option.substr(equals + 1);
    if (name == "ttl") {
      if (!IsWithin(value, 0, kMaxTtl)) return "must have a ttl of 0 to 255";
    } else if (name == "recv_buf_size") {
      if (!IsWithin(value, 1, kMaxBytes)) return "must have a positive number as recv_buf_size";
    } else if (name != "transmit_only") {
      return "must have no option \"" + name + "\", only ttl, recv_buf_size and transmit_only";
    }
  }
  return {};
}

}  // namespace

std::string LcmUrlProblem(const std::string& url) {
  constexpr std::uint32_t kMaxPort = 65535;
  const UrlParts parts = Split(url);
  const bool is_udpm = parts.scheme == "udpm";
  if (parts.scheme == "memq" || parts.scheme == "file") return {};
  if (!is_udpm && parts.scheme != "tcpq") {
    return "must begin with udpm://, tcpq://, memq:// or file://";
  }
  // Without either, LCM takes its own default.
  const bool is_default = parts.host.empty() && !parts.has_port;
  if (is_udpm && !is_default && !IsMulticast(parts.host)) {
    return "must have a multicast address after udpm://, as 239.255.76.67";
  }
  if (parts.has_port && !IsWithin(parts.port, 1, kMaxPort)) return "must have a port of 1 to 65535";
  return is_udpm ? UdpmOptionsProblem(parts.options) : std::string();
}

}  // namespace voqcal
