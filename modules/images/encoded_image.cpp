#include "images/encoded_image.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace voqcal {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <std::size_t N>
bool Contains(const Bytes& bytes, std::size_t begin, const std::array<std::uint8_t, N>& sought) {
  return std::search(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                     bytes.end(),
                     sought.begin(),
                     sought.end()) != bytes.end();
}

template <std::size_t N>
bool StartsWith(const Bytes& bytes, const std::array<std::uint8_t, N>& prefix) {
  return bytes.size() >= N && std::equal(prefix.begin(), prefix.end(), bytes.begin());
}

int BigEndian16(const Bytes& bytes, std::size_t at) { return bytes[at] * 256 + bytes[at + 1]; }

/// PNG, ISO/IEC 15948: signature, then the chunk IHDR: length 4, type 4, width 4, height 4.
std::optional<EncodedImageInfo> InspectPng(const Bytes& bytes) {
  constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::size_t kWidthAt = 16;
  constexpr std::size_t kHeightAt = 20;
  if (!StartsWith(bytes, kSignature) || bytes.size() < kHeightAt + 4) return std::nullopt;
  // No camera has 65536 pixels a side: the upper halves must be zero.
  if (BigEndian16(bytes, kWidthAt) != 0 || BigEndian16(bytes, kHeightAt) != 0) return std::nullopt;
  EncodedImageInfo info;
  info.width_px = BigEndian16(bytes, kWidthAt + 2);
  info.height_px = BigEndian16(bytes, kHeightAt + 2);
  info.has_end = Contains<4>(bytes, kHeightAt, {'I', 'E', 'N', 'D'});
  return info;
}

/// JPEG, ITU-T T.81 Annex B: SOI, then segments of FF, marker, length 2 (which counts itself). A
/// frame header is marker C0..CF but C4, C8, CC: precision 1, height 2, width 2. Entropy-coded data
/// after SOS hold no FF D9, so that there it is the end.
std::optional<EncodedImageInfo> InspectJpeg(const Bytes& bytes) {
  if (!StartsWith<3>(bytes, {0xFF, 0xD8, 0xFF})) return std::nullopt;
  std::size_t at = 2;
  while (at + 9 <= bytes.size() && bytes[at] == 0xFF) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    const bool is_frame_header =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    const std::size_t next = at + 2 + static_cast<std::size_t>(BigEndian16(bytes, at + 2));
    if (is_frame_header) {
      EncodedImageInfo info;
      info.is_jpeg = true;
      info.height_px = BigEndian16(bytes, at + 5);
      info.width_px = BigEndian16(bytes, at + 7);
      info.has_end = next < bytes.size() && Contains<2>(bytes, next, {0xFF, 0xD9});
      return info;
    }
    at = next;
  }
  return std::nullopt;
}

}  // namespace

std::optional<EncodedImageInfo> InspectEncodedImage(const std::vector<std::uint8_t>& bytes) {
  if (const auto jpeg = InspectJpeg(bytes)) return jpeg;
  return InspectPng(bytes);
}

}  // namespace voqcal
