// RoomAlbedo: what the room's surfaces look like. Smooth mottling everywhere, and hard edges
// (tiles, posters, stripes) that give both sensors something to see. Nothing here looks like a
// chessboard.

#include <algorithm>
#include <cmath>

#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/room.hpp"

namespace voqcal {
namespace {

using Colour = Eigen::Vector3f;  // blue, green, red in [0, 1]

float LatticeValue(int i, int j, int key) {
  const auto bits = static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32 |
                    static_cast<std::uint32_t>(j);
  return static_cast<float>(MixBits(MixBits(bits) + key) >> 40) * 0x1p-24F;
}

// Smooth noise in [0, 1]: random values on a unit lattice, blended with 3t^2 - 2t^3.
float Mottling(double u, double v, int key) {
  const int i = static_cast<int>(std::floor(u));
  const int j = static_cast<int>(std::floor(v));
  const auto blend = [](double t) { return static_cast<float>(t * t * (3.0 - 2.0 * t)); };
  const float a = blend(u - i);
  const float b = blend(v - j);
  const float low = (1 - a) * LatticeValue(i, j, key) + a * LatticeValue(i + 1, j, key);
  const float high = (1 - a) * LatticeValue(i, j + 1, key) + a * LatticeValue(i + 1, j + 1, key);
  return (1 - b) * low + b * high;
}

double Modulo(double value, double period) { return value - period * std::floor(value / period); }

// Width of a repeated line of `width_m` at every `period_m`.
bool IsOnLine(double value_m, double period_m, double width_m) {
  return Modulo(value_m, period_m) < width_m;
}

Colour Floor(double u, double v) {
  constexpr double kTileM = 0.5;
  if (IsOnLine(u, kTileM, 0.012) || IsOnLine(v, kTileM, 0.012)) return Colour::Constant(0.24F);
  const auto tile_u = static_cast<int>(std::floor(u / kTileM));
  const auto tile_v = static_cast<int>(std::floor(v / kTileM));
  return Colour(0.47F, 0.50F, 0.53F) * (0.95F + 0.05F * LatticeValue(tile_u, tile_v, 1));
}

Colour Ceiling(double u, double v) {
  if (Modulo(u, 2.4) < 1.2 && Modulo(v + 0.15, 2.0) < 0.3)
    return Colour(0.97F, 1.0F, 1.0F);  // lamp
  if (IsOnLine(u, 0.6, 0.02) || IsOnLine(v, 0.6, 0.02)) return Colour::Constant(0.5F);
  return Colour(0.76F, 0.77F, 0.77F);
}

// A poster of its own size and colour in every stretch of wall, with a disc and a band on it.
bool FindPoster(double u, double v, int surface, Colour* colour) {
  constexpr double kStretchM = 1.6;
  const auto stretch = static_cast<int>(std::floor(u / kStretchM));
  const double half_width_m = 0.2 + 0.3 * LatticeValue(stretch, 2, surface);
  const double half_height_m = 0.25 + 0.2 * LatticeValue(stretch, 3, surface);
  const double du = u - (stretch + 0.5) * kStretchM;
  const double dv = v - 0.3 - 0.3 * LatticeValue(stretch, 4, surface);
  if (std::abs(du) > half_width_m || std::abs(dv) > half_height_m) return false;
  const Colour paper(LatticeValue(stretch, 5, surface),
                     LatticeValue(stretch, 6, surface),
                     LatticeValue(stretch, 7, surface));
  const bool is_disc = std::hypot(du, dv - 0.06) < 0.6 * std::min(half_width_m, half_height_m);
  const bool is_band = dv < -0.6 * half_height_m;
  *colour = is_disc   ? Colour(Colour::Ones() - 0.8F * paper)
            : is_band ? Colour(0.3F * paper)
                      : Colour(0.15F * Colour::Ones() + 0.75F * paper);
  return true;
}

Colour Wall(double u, double v, int surface) {
  constexpr double kDadoZM = -0.35;  // painted darker up to here
  Colour poster;
  if (FindPoster(u, v, surface, &poster)) return poster;
  if (v < -1.1) return Colour(0.12F, 0.14F, 0.15F);  // skirting
  if (std::abs(v - kDadoZM) < 0.02) return Colour(0.15F, 0.2F, 0.2F);
  return v < kDadoZM ? Colour(0.42F, 0.46F, 0.36F) : Colour(0.68F, 0.73F, 0.75F);
}

Colour Door(double u, double v) {
  const double du = u + 1.8;  // from the door's middle
  if (std::abs(du) < 0.08 && v > 0.0 && v < 0.6) return Colour(0.2F, 0.15F, 0.1F);  // window
  if (std::abs(du - 0.38) < 0.05 && std::abs(v + 0.2) < 0.03)
    return Colour::Constant(0.85F);  // handle
  return Colour(0.5F, 0.4F, 0.2F);
}

Colour Pillar(double u, double v) {
  const bool has_stripes = v > -0.9 && v < -0.4;
  if (!has_stripes) return Colour(0.58F, 0.6F, 0.6F);
  return Modulo(u + v, 0.24) < 0.12 ? Colour(0.1F, 0.75F, 0.85F) : Colour(0.08F, 0.08F, 0.08F);
}

Colour Table(double u, double v) {
  const auto grain = static_cast<float>(std::sin(60.0 * v + 3.0 * std::sin(5.0 * u)));
  return Colour(0.2F, 0.36F, 0.52F) * (1.0F + 0.12F * grain);
}

Colour Crate(double u, double v) {
  if (IsOnLine(u + 0.03, 0.3, 0.05)) return Colour(0.55F, 0.68F, 0.75F);  // tape
  return IsOnLine(v, 0.25, 0.01) ? Colour(0.12F, 0.2F, 0.28F) : Colour(0.28F, 0.42F, 0.56F);
}

Colour Cupboard(double u, double v) {
  if (IsOnLine(u, 0.6, 0.015)) return Colour::Constant(0.1F);
  return std::abs(v + 0.3) < 0.01 ? Colour::Constant(0.12F) : Colour(0.52F, 0.42F, 0.36F);
}

// Striped or plain, in a colour of its own for each garment.
Colour Cloth(double v, int surface) {
  const Colour colour(
      LatticeValue(surface, 8, 0), LatticeValue(surface, 9, 0), LatticeValue(surface, 10, 0));
  const bool has_stripes = LatticeValue(surface, 11, 0) > 0.6F;
  const float shade = has_stripes && IsOnLine(v, 0.1, 0.05) ? 0.5F : 1.0F;
  return shade * (0.1F * Colour::Ones() + 0.6F * colour);
}

Colour Paint(Material material, double u, double v, int surface) {
  switch (material) {
    case Material::kFloor:
      return Floor(u, v);
    case Material::kCeiling:
      return Ceiling(u, v);
    case Material::kWall:
      return Wall(u, v, surface);
    case Material::kDoor:
      return Door(u, v);
    case Material::kPillar:
      return Pillar(u, v);
    case Material::kTable:
      return Table(u, v);
    case Material::kCrate:
      return Crate(u, v);
    case Material::kCupboard:
      return Cupboard(u, v);
    case Material::kCloth:
      return Cloth(v, surface);
    case Material::kSkin:
      return Colour(0.45F, 0.55F, 0.72F);
    case Material::kMetal:
      return Colour::Constant(0.12F);
    case Material::kWhiteboard:
      return Colour(0.82F, 0.83F, 0.83F);
  }
  return Colour::Zero();
}

}  // namespace

Eigen::Vector3f RoomAlbedo(const RoomHit& hit) {
  // Coordinates on the face: height is v on upright faces.
  const Eigen::Vector3d& p = hit.point_lidar_m;
  const double u = hit.normal_lidar.x() != 0 ? p.y() : p.x();
  const double v = hit.normal_lidar.z() != 0 ? p.y() : p.z();
  const float mottling = 0.84F + 0.10F * Mottling(1.1 * u, 1.1 * v, hit.surface) +
                         0.06F * Mottling(7.0 * u, 7.0 * v, hit.surface);
  return (mottling * Paint(hit.material, u, v, hit.surface)).cwiseMin(1.0F);
}

}  // namespace voqcal
