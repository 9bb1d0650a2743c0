#include "core/simulation/keyed_noise.hpp"

#include <cmath>

namespace voqcal {
namespace {

constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;  // 2^64 / golden ratio, splitmix64's step

}  // namespace

std::uint64_t MixBits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

KeyedNoise::KeyedNoise(std::uint32_t seed, NoiseUse use, std::int64_t frame_us)
    : key_(MixBits(MixBits(MixBits(seed + kGolden) ^ (static_cast<std::uint64_t>(use) * kGolden)) ^
                   static_cast<std::uint64_t>(frame_us))) {}

std::uint64_t KeyedNoise::Bits(std::uint64_t index) const {
  return MixBits(key_ + (index + 1) * kGolden);
}

double KeyedNoise::Uniform(std::uint64_t index) const {
  return (static_cast<double>(Bits(index) >> 12) + 0.5) * 0x1p-52;
}

std::pair<double, double> KeyedNoise::Normals(std::uint64_t index) const {
  // Box and Muller 1958; Uniform is never zero, so the logarithm is finite.
  const double radius = std::sqrt(-2.0 * std::log(Uniform(2 * index)));
  const double angle_rad = 2.0 * M_PI * Uniform(2 * index + 1);
  return {radius * std::cos(angle_rad), radius * std::sin(angle_rad)};
}

}  // namespace voqcal
