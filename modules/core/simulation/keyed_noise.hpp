#pragma once

#include <cstdint>
#include <utility>

namespace voqcal {

/// What a random number is for: streams of different use never share numbers.
enum class NoiseUse : std::uint64_t {
  kStops = 1,
  kStopOrder,
  kRingBias,
  kRange,
  kDropout,
  kPixelTable,
  kPixelRow,
  kClutter,
  kPointing,
  kHolds,
};

/// Random numbers without state: each is a hash of (seed, use, frame time, index), so it does not
/// matter who asks first, how often, or from which process.
class KeyedNoise {
 public:
  KeyedNoise(std::uint32_t seed, NoiseUse use, std::int64_t frame_us = 0);

  std::uint64_t Bits(std::uint64_t index) const;                 ///< 64 even bits.
  double Uniform(std::uint64_t index) const;                     ///< In the open interval (0, 1).
  std::pair<double, double> Normals(std::uint64_t index) const;  ///< Two independent N(0, 1).

 private:
  std::uint64_t key_;
};

/// Spreads the bits of `x` evenly: the finaliser of splitmix64 (Steele, Lea and Flood 2014, "Fast
/// splittable pseudorandom number generators", variant 13 of Stafford's mixers).
std::uint64_t MixBits(std::uint64_t x);

}  // namespace voqcal
