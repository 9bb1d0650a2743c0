#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/lidar_packets/packet_stream.hpp"

namespace voqcal::test {

inline std::string ReadBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <typename T>
T FieldAt(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

/// A datagram of a capture.
struct CapturedPacket {
  std::int64_t utime = 0;
  std::string bytes;
};

/// The datagrams to `port` of a little-endian Ethernet capture without VLAN tags, IP options or
/// fragments.
inline std::vector<CapturedPacket> ReadCapture(const std::filesystem::path& path, int port) {
  constexpr std::size_t kHeaders = 14 + 20 + 8;
  const std::string bytes = ReadBytes(path);
  std::vector<CapturedPacket> packets;
  for (std::size_t at = 24; at + 16 <= bytes.size();) {
    const std::int64_t utime = FieldAt<std::uint32_t>(bytes, at) * std::int64_t{1000000} +
                               FieldAt<std::uint32_t>(bytes, at + 4);
    const auto size = FieldAt<std::uint32_t>(bytes, at + 8);
    const auto* const frame = reinterpret_cast<const std::uint8_t*>(bytes.data()) + at + 16;
    if (size > kHeaders && (frame[36] << 8 | frame[37]) == port) {
      packets.push_back({utime, bytes.substr(at + 16 + kHeaders, size - kHeaders)});
    }
    at += 16 + size;
  }
  return packets;
}

/// All sweeps of a capture, with the stream's counts.
struct DecodedCapture {
  std::vector<TimedSweep> sweeps;
  std::map<std::string, std::int64_t> counts;
};

inline DecodedCapture DecodeCapture(const std::filesystem::path& path,
                                    int port,
                                    const LidarPacketOptions& options) {
  DecodedCapture decoded;
  LidarPacketStream stream(options);
  const auto append = [&decoded](std::vector<TimedSweep> more) {
    for (TimedSweep& sweep : more) decoded.sweeps.push_back(std::move(sweep));
  };
  for (const CapturedPacket& packet : ReadCapture(path, port)) {
    const auto* const data = reinterpret_cast<const std::uint8_t*>(packet.bytes.data());
    append(stream.Add({data, packet.bytes.size()}, packet.utime));
  }
  append(stream.Finish());
  decoded.counts = stream.Counts();
  return decoded;
}

}  // namespace voqcal::test
