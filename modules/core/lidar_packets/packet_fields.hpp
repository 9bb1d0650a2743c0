#pragma once

#include <cstddef>
#include <cstdint>

namespace voqcal {

// Fields of packets, wherever they are. The caller has made sure that they are there.

inline int Read16(const std::uint8_t* bytes) { return bytes[0] | bytes[1] << 8; }

inline std::uint64_t ReadLittle(const std::uint8_t* bytes, int num_bytes) {
  std::uint64_t value = 0;
  for (int i = num_bytes - 1; i >= 0; --i) value = value << 8 | bytes[i];
  return value;
}

inline std::uint32_t Read32(const std::uint8_t* bytes) {
  return static_cast<std::uint32_t>(ReadLittle(bytes, 4));
}

inline std::uint64_t ReadBig(const std::uint8_t* bytes, int num_bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < num_bytes; ++i) value = value << 8 | bytes[i];
  return value;
}

}  // namespace voqcal
