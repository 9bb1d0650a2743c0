#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace voqcal {

/// One datagram's payload.
struct HostPacket {
  std::int64_t utime = 0;  ///< When this host received it, microseconds since the Unix epoch.
  std::vector<std::uint8_t> bytes;
};

/// A port that nobody listens to here.
struct OtherPort {
  int port = 0;
  std::int64_t num_packets = 0;
};

/// Where a lidar's datagrams come from, one after the other.
class PacketSource {
 public:
  virtual ~PacketSource() = default;

  /// The next datagram; nothing if there is none now (after a short wait), or never will be.
  virtual std::optional<HostPacket> Next() = 0;

  /// True once there will never be a datagram again.
  virtual bool HasEnded() const = 0;

  /// The capture's file or the network's address, as errors name it.
  virtual std::string Name() const = 0;

  /// The one of the ports that were not listened to which got most packets, if any.
  virtual std::optional<OtherPort> BusiestOtherPort() const { return std::nullopt; }

  /// "running", or what it waits for.
  virtual std::string State() const { return "running"; }

  /// What was left out, by reason.
  virtual const std::map<std::string, std::int64_t>& Counts() const = 0;
};

}  // namespace voqcal
