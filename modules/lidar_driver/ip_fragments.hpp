#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/lidar_packets/packet.hpp"

namespace voqcal {

/// Puts IPv4 datagrams together that were sent in pieces, as those of Ouster's lidars are on a
/// network of 1500 bytes a frame. What the kernel does for a socket, a capture leaves to its
/// reader.
class IpFragments {
 public:
  /// True if it is a piece of a datagram.
  static bool IsPiece(PacketBytes ip);

  /// @param ip  a frame's IPv4 packet.
  /// @return the datagram as one packet, when its last missing piece came.
  std::optional<std::vector<std::uint8_t>> Add(PacketBytes ip);

 private:
  /// What has come of one datagram.
  struct Pieces {
    std::map<std::size_t, std::vector<std::uint8_t>> by_offset;
    std::optional<std::size_t> size;  // known once the last piece is there
  };

  Pieces& PiecesOf(const std::string& name);

  std::map<std::string, Pieces> pieces_;  // by sender, receiver, protocol and number
  std::deque<std::string> names_;         // the oldest first
};

}  // namespace voqcal
