#include "lidar_driver/ip_fragments.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A piece of datagram `number`: its payload counts on from `offset`.
Bytes Piece(int number, std::size_t offset, std::size_t num_bytes, bool has_more) {
  Bytes ip(20 + num_bytes, 0);
  ip[0] = 0x45;
  ip[2] = static_cast<std::uint8_t>(ip.size() >> 8);
  ip[3] = static_cast<std::uint8_t>(ip.size());
  ip[5] = static_cast<std::uint8_t>(number);
  ip[6] = static_cast<std::uint8_t>((has_more ? 0x20 : 0) | offset / 8 >> 8);
  ip[7] = static_cast<std::uint8_t>(offset / 8);
  ip[9] = 17;
  for (std::size_t i = 0; i < num_bytes; ++i) ip[20 + i] = static_cast<std::uint8_t>(offset + i);
  return ip;
}

std::optional<Bytes> Add(IpFragments* fragments, const Bytes& ip) {
  return fragments->Add({ip.data(), ip.size()});
}

bool IsWhole(const std::optional<Bytes>& ip, std::size_t num_bytes) {
  if (!ip || ip->size() != 20 + num_bytes || (*ip)[6] != 0 || (*ip)[7] != 0) return false;
  for (std::size_t i = 0; i < num_bytes; ++i) {
    if ((*ip)[20 + i] != static_cast<std::uint8_t>(i)) return false;
  }
  return true;
}

TEST(IpFragments, JoinsPiecesInAnyOrder) {
  IpFragments fragments;
  EXPECT_FALSE(Add(&fragments, Piece(1, 80, 16, false)));
  EXPECT_FALSE(Add(&fragments, Piece(1, 0, 40, true)));
  EXPECT_TRUE(IsWhole(Add(&fragments, Piece(1, 40, 40, true)), 96));
}

TEST(IpFragments, KeepsDatagramsApart) {
  IpFragments fragments;
  EXPECT_FALSE(Add(&fragments, Piece(1, 0, 40, true)));
  EXPECT_FALSE(Add(&fragments, Piece(2, 0, 40, true)));
  EXPECT_TRUE(IsWhole(Add(&fragments, Piece(2, 40, 8, false)), 48));
  EXPECT_TRUE(IsWhole(Add(&fragments, Piece(1, 40, 16, false)), 56));
}

TEST(IpFragments, BeginsAnewWhereANumberComesRound) {
  IpFragments fragments;
  EXPECT_FALSE(Add(&fragments, Piece(1, 0, 48, true)));  // its end was lost
  EXPECT_FALSE(Add(&fragments, Piece(1, 0, 40, true)));
  EXPECT_TRUE(IsWhole(Add(&fragments, Piece(1, 40, 8, false)), 48));
}

TEST(IpFragments, RefusesWhatIsNoPiece) {
  IpFragments fragments;
  EXPECT_FALSE(Add(&fragments, Piece(1, 0, 40, false)));
  EXPECT_FALSE(Add(&fragments, Bytes(10, 0x45)));
  Bytes cut = Piece(1, 0, 40, true);
  cut.resize(30);
  EXPECT_FALSE(Add(&fragments, cut));
}

}  // namespace
}  // namespace voqcal
