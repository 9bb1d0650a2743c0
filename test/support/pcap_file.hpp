#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace voqcal::test {

/// One datagram and the Ethernet frame around it, written field by field (IEEE 802.3, RFC 791, RFC
/// 768; checksums are left at 0).
struct UdpFrame {
  int port = 2368;
  std::vector<std::uint8_t> payload;
  int fragment = 0;  ///< Flags and offset of the IP header.

  std::vector<std::uint8_t> Ip() const {
    std::vector<std::uint8_t> ip(20, 0);
    ip[0] = 0x45;
    SetBig16(2, static_cast<int>(28 + payload.size()), &ip);
    SetBig16(6, fragment, &ip);
    ip[9] = 17;
    std::vector<std::uint8_t> udp(8, 0);
    SetBig16(2, port, &udp);
    SetBig16(4, static_cast<int>(8 + payload.size()), &udp);
    ip.insert(ip.end(), udp.begin(), udp.end());
    ip.insert(ip.end(), payload.begin(), payload.end());
    return ip;
  }

  /// @param link_header  what stands before the IP header.
  std::vector<std::uint8_t> After(std::vector<std::uint8_t> link_header) const {
    const auto ip = Ip();
    link_header.insert(link_header.end(), ip.begin(), ip.end());
    return link_header;
  }

  std::vector<std::uint8_t> Ethernet() const {
    std::vector<std::uint8_t> header(14, 0);
    SetBig16(12, 0x0800, &header);
    return After(header);
  }

 private:
  static void SetBig16(std::size_t at, int value, std::vector<std::uint8_t>* bytes) {
    (*bytes)[at] = static_cast<std::uint8_t>(value >> 8);
    (*bytes)[at + 1] = static_cast<std::uint8_t>(value);
  }
};

/// A capture file of Ethernet frames (pcap 2.4, microseconds, little-endian).
class PcapFile {
 public:
  PcapFile() {
    Write32(0xA1B2C3D4);
    Write32(2 | 4 << 16);
    Write32(0);
    Write32(0);
    Write32(65535);
    Write32(1);
  }

  void Add(std::int64_t utime, const std::vector<std::uint8_t>& frame) {
    Write32(static_cast<std::uint32_t>(utime / 1000000));
    Write32(static_cast<std::uint32_t>(utime % 1000000));
    Write32(static_cast<std::uint32_t>(frame.size()));
    Write32(static_cast<std::uint32_t>(frame.size()));
    bytes_.append(frame.begin(), frame.end());
  }

  const std::string& Bytes() const { return bytes_; }

 private:
  void Write32(std::uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xff);
  }

  std::string bytes_;
};

}  // namespace voqcal::test
