#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voqcal {

/// The bytes of a message as LCM sends and logs them; none if it cannot be encoded. Message is an
/// lcm-gen type.
template <typename Message>
std::vector<std::uint8_t> EncodeMessage(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int num_encoded = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  if (num_encoded != static_cast<int>(bytes.size())) bytes.clear();
  return bytes;
}

}  // namespace voqcal
