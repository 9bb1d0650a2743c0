#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/lidar_packets/packet.hpp"

namespace voqcal::test {

/// A VLP-16 data packet, written field by field as its manual shows it.
struct Vlp16PacketWriter {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(1206, 0);

  /// @param step  centidegrees from block to block; blocks of a pair share one in dual mode.
  Vlp16PacketWriter(int azimuth_cdeg, int step, std::uint32_t time_us, std::uint8_t mode = 0x37) {
    for (int block = 0; block < 12; ++block) {
      const int turned = mode == 0x39 ? block / 2 : block;
      bytes[block * 100] = 0xFF;
      bytes[block * 100 + 1] = 0xEE;
      Write16(block * 100 + 2, (azimuth_cdeg + turned * step) % 36000);
    }
    for (int i = 0; i < 4; ++i) bytes[1200 + i] = static_cast<std::uint8_t>(time_us >> (8 * i));
    bytes[1204] = mode;
    bytes[1205] = 0x22;
  }

  void Write16(int at, int value) {
    bytes[at] = static_cast<std::uint8_t>(value & 0xff);
    bytes[at + 1] = static_cast<std::uint8_t>(value >> 8);
  }
  void SetEcho(int block, int firing, int laser, int distance_2mm, int intensity) {
    const int at = block * 100 + 4 + 3 * (16 * firing + laser);
    Write16(at, distance_2mm);
    bytes[at + 2] = static_cast<std::uint8_t>(intensity);
  }
  void SetAllEchoes(int distance_2mm, int intensity) {
    for (int block = 0; block < 12; ++block) {
      for (int i = 0; i < 32; ++i) SetEcho(block, i / 16, i % 16, distance_2mm, intensity);
    }
  }
  PacketBytes Bytes() const { return {bytes.data(), bytes.size()}; }
};

constexpr double kVlp16PacketUs = 12 * 110.592;  ///< From one packet to the next.

/// Turns of 75 packets, each beam with an echo at 3 m.
inline std::vector<Vlp16PacketWriter> Vlp16Turns(int num_packets) {
  constexpr int kStep = 40;
  std::vector<Vlp16PacketWriter> packets;
  for (int i = 0; i < num_packets; ++i) {
    packets.emplace_back(i * 12 * kStep % 36000,
                         kStep,
                         static_cast<std::uint32_t>(1000 + std::llround(i * kVlp16PacketUs)));
    packets.back().SetAllEchoes(1500, 50);
  }
  return packets;
}

}  // namespace voqcal::test
