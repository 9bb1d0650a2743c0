#include "rig/listening_address.hpp"

#include <cstdint>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace voqcal {
namespace {

in_addr_t AddressOf(const sockaddr* address) {
  return reinterpret_cast<const sockaddr_in*>(address)->sin_addr.s_addr;
}

/// Of a network card, or its network's broadcast.
bool IsOfThisHost(in_addr_t address) {
  ifaddrs* cards = nullptr;
  if (getifaddrs(&cards) != 0) return true;  // nothing to go by
  bool is_of_this_host = false;
  for (const ifaddrs* card = cards; card != nullptr; card = card->ifa_next) {
    if (card->ifa_addr == nullptr || card->ifa_addr->sa_family != AF_INET) continue;
    is_of_this_host |= AddressOf(card->ifa_addr) == address;
    if ((card->ifa_flags & IFF_BROADCAST) != 0 && card->ifa_broadaddr != nullptr) {
      is_of_this_host |= AddressOf(card->ifa_broadaddr) == address;
    }
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
    return "only what this host itself sends arrives there: for a lidar on the network give this "
           "host's own address (0.0.0.0: of every network card)";
  }
  const bool is_of_all = parsed.s_addr == INADDR_ANY || parsed.s_addr == INADDR_BROADCAST;
  if (is_of_all || IsOfThisHost(parsed.s_addr)) return "";
  return "no network card of this host has this address: give this host's own, not the lidar's "
         "(0.0.0.0: of every network card)";
}

}  // namespace voqcal
