#include "rig/listening_address.hpp"

#include <cstdint>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>

namespace voqcal {
namespace {

bool IsOfThisHost(in_addr_t address) {
  ifaddrs* cards = nullptr;
  if (getifaddrs(&cards) != 0) return true;  // nothing to go by
  bool is_of_this_host = false;
  for (const ifaddrs* card = cards; card != nullptr; card = card->ifa_next) {
    if (card->ifa_addr == nullptr || card->ifa_addr->sa_family != AF_INET) continue;
    const auto* own = reinterpret_cast<const sockaddr_in*>(card->ifa_addr);
    is_of_this_host |= own->sin_addr.s_addr == address;
  }
  freeifaddrs(cards);
  return is_of_this_host;
}

}  // namespace

std::string AddressDoubt(const std::string& address) {
  in_addr parsed{};
  if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) return "this is no IPv4 address";
  constexpr std::uint32_t kLoopback = 127;
  if (ntohl(parsed.s_addr) >> 24 == kLoopback) {
    return "only what this host itself sends arrives there: for a lidar on the network let "
           "lidar_driver.sensor.address be this host's own (0.0.0.0: of every network card)";
  }
  if (parsed.s_addr == INADDR_ANY || IsOfThisHost(parsed.s_addr)) return "";
  return "no network card of this host has this address: lidar_driver.sensor.address is this "
         "host's own, not the lidar's (0.0.0.0: of every network card)";
}

}  // namespace voqcal
