#include "lidar_driver/ip_fragments.hpp"

#include <utility>

namespace voqcal {
namespace {

constexpr std::size_t kMinHeader = 20;
constexpr std::size_t kMaxDatagrams = 64;  // of which pieces are kept

// The packet as if it had come in one piece; nothing if there are gaps.
std::optional<std::vector<std::uint8_t>> Joined(
    PacketBytes ip,
    std::size_t header,
    const std::map<std::size_t, std::vector<std::uint8_t>>& by_offset,
    std::size_t size) {
  std::vector<std::uint8_t> whole(ip.data, ip.data + header);
  whole[6] = whole[7] = 0;  // no fragment any more
  for (const auto& [offset, bytes] : by_offset) {
    if (offset != whole.size() - header) return std::nullopt;
    whole.insert(whole.end(), bytes.begin(), bytes.end());
  }
  if (whole.size() - header != size) return std::nullopt;
  return whole;
}

}  // namespace

bool IpFragments::IsPiece(PacketBytes ip) {
  // "More fragments", or an offset.
  return ip.size >= kMinHeader && ip.data[0] >> 4 == 4 &&
         ((ip.data[6] & 0x3F) != 0 || ip.data[7] != 0);
}

std::optional<std::vector<std::uint8_t>> IpFragments::Add(PacketBytes ip) {
  if (!IsPiece(ip)) return std::nullopt;
  const std::size_t header = std::size_t{4} * (ip.data[0] & 0x0F);
  const auto stated = static_cast<std::size_t>(ip.data[2] << 8 | ip.data[3]);
  if (header < kMinHeader || stated < header || stated > ip.size) return std::nullopt;
  const int flags_and_offset = ip.data[6] << 8 | ip.data[7];
  const bool has_more = (flags_and_offset & 0x2000) != 0;
  const auto offset = static_cast<std::size_t>(flags_and_offset & 0x1FFF) * 8;
  std::string name(ip.data + 12, ip.data + 20);
  name.append({static_cast<char>(ip.data[9]),
               static_cast<char>(ip.data[4]),
               static_cast<char>(ip.data[5])});
  Pieces& pieces = PiecesOf(name);
  // Numbers come round: a piece that is there already is of the next datagram of that number.
  if (pieces.by_offset.count(offset) > 0) pieces = {};
  pieces.by_offset[offset].assign(ip.data + header, ip.data + stated);
  if (!has_more) pieces.size = offset + stated - header;
  if (!pieces.size) return std::nullopt;
  auto whole = Joined(ip, header, pieces.by_offset, *pieces.size);
  if (whole) pieces = {};
  return whole;
}

IpFragments::Pieces& IpFragments::PiecesOf(const std::string& name) {
  const auto [place, is_new] = pieces_.try_emplace(name);
  if (is_new) names_.push_back(name);
  if (names_.size() > kMaxDatagrams) {
    pieces_.erase(names_.front());
    names_.pop_front();
  }
  return place->second;
}

}  // namespace voqcal
