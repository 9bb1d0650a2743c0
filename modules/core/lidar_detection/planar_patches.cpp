#include "core/lidar_detection/planar_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <Eigen/LU>

#include "core/lidar_detection/voxel_grid.hpp"

namespace voqcal {
namespace {

constexpr std::int32_t kNone = -1;

/// What is known of the surface around one cell.
struct CellSurface {
  PlaneFit plane;  // of the 3 x 3 x 3 cells around it
  bool is_planar = false;
  std::int32_t patch = kNone;
};

/// Certainly thicker than `thickness_m` (1 sigma), told without eigenvalues: the least is at least
/// the determinant over the square of half the trace, as the other two multiply to no more.
bool IsBulky(const PointMoments& moments, double thickness_m) {
  const Eigen::Matrix3d covariance_m2 = moments.CovarianceM2();
  const double half_trace_m2 = covariance_m2.trace() / 2;
  return covariance_m2.determinant() > thickness_m * thickness_m * half_trace_m2 * half_trace_m2;
}

/// Narrower (1 sigma), points are as good as on a line, which has no plane.
double MinWidthM(const PatchSearchOptions& options) { return options.voxel_m / 5; }

/// Fits a surface to the surroundings of each cell.
std::vector<CellSurface> FitSurfaces(const VoxelGrid& grid, const PatchSearchOptions& options) {
  constexpr double kMinPoints = 12;  // two scan lines of six points
  // Noise of 10 mm and scan lines up to 30 mm apart give at most about 20 mm (1 sigma); a single
  // scan line spreads along one axis only.
  const double max_thickness_m = options.band_m / 2;
  std::vector<CellSurface> surfaces(grid.NumCells());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    PointMoments around;
    grid.ForEachTouching(i, [&](std::size_t near) { around.Add(grid.Moments(near)); });
    if (around.num < kMinPoints || IsBulky(around, max_thickness_m)) continue;
    surfaces[i].plane = FitPlane(around);
    surfaces[i].is_planar = surfaces[i].plane.spread_m[0] < max_thickness_m &&
                            surfaces[i].plane.spread_m[1] > MinWidthM(options);
  }
  return surfaces;
}

/// Flattest first; ties by place, so that the points' order does not matter.
std::vector<std::size_t> SeedOrder(const std::vector<CellSurface>& surfaces) {
  std::vector<std::pair<std::int64_t, std::size_t>> ranked;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    // To 0.1 mm: the rounding of sums must not decide.
    if (surfaces[i].is_planar)
      ranked.emplace_back(std::llround(surfaces[i].plane.spread_m[0] * 1e4), i);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::size_t> seeds;
  seeds.reserve(ranked.size());
  for (const auto& [flatness, i] : ranked) seeds.push_back(i);
  return seeds;
}

/// Whether a cell that is in no patch yet continues `plane`.
bool Continues(const PlaneFit& plane,
               std::size_t cell,
               const VoxelGrid& grid,
               const PatchSearchOptions& options,
               const std::vector<CellSurface>& surfaces) {
  constexpr double kMinNormalCosine = 0.9;  // 26 degrees: surfaces of small cells are rough
  const CellSurface& surface = surfaces[cell];
  if (surface.patch != kNone) return false;
  if (std::abs(plane.DistanceM(grid.MeanM(cell))) > options.band_m) return false;
  return !surface.is_planar || std::abs(surface.plane.normal.dot(plane.normal)) >= kMinNormalCosine;
}

/// All cells that continue the plane of `seed` from one to the next.
std::vector<std::size_t> Grow(std::size_t seed,
                              std::int32_t patch,
                              const VoxelGrid& grid,
                              const PatchSearchOptions& options,
                              std::vector<CellSurface>* surfaces) {
  PlaneFit plane = (*surfaces)[seed].plane;
  PointMoments moments;
  std::size_t num_at_fit = 27;  // the surface is about as good as this many cells
  std::vector<std::size_t> members = {seed};
  (*surfaces)[seed].patch = patch;
  for (std::size_t next = 0; next < members.size(); ++next) {
    moments.Add(grid.Moments(members[next]));
    if (next >= 2 * num_at_fit) {
      plane = FitPlane(moments);
      num_at_fit = next;
    }
    grid.ForEachTouching(members[next], [&](std::size_t i) {
      if (!Continues(plane, i, grid, options, *surfaces)) return;
      (*surfaces)[i].patch = patch;
      members.push_back(i);
    });
  }
  return members;
}

PlanarPatch Describe(const std::vector<std::size_t>& members, const VoxelGrid& grid) {
  PlanarPatch patch;
  PointMoments moments;
  for (const std::size_t i : members) {
    moments.Add(grid.Moments(i));
    patch.middle_m += grid.MeanM(i) / static_cast<double>(members.size());
  }
  patch.plane = FitPlane(moments);
  patch.num_points = static_cast<int>(moments.num);
  return patch;
}

/// How far the patch's spread is from that looked for, as a factor's logarithm.
double Unlikeness(const PlanarPatch& patch, const PatchSearchOptions& options) {
  const double shorter = std::abs(std::log(patch.plane.spread_m[1] / options.spread_m[0]));
  const double longer = std::abs(std::log(patch.plane.spread_m[2] / options.spread_m[1]));
  return std::max(shorter, longer);
}

/// A wall or a floor. A board with a pole or a person in its plane is long, but no wider.
bool IsTooLarge(const PlanarPatch& patch, const PatchSearchOptions& options) {
  return patch.plane.spread_m[1] > 2 * options.spread_m[0] ||
         patch.plane.spread_m[2] > 3 * options.spread_m[1];
}

/// The members around their common middle: a pole, a leg or a shelf in the plane may hang on to a
/// board. Empty if these are not most of it.
std::vector<std::size_t> Compact(const std::vector<std::size_t>& members,
                                 const VoxelGrid& grid,
                                 const PatchSearchOptions& options) {
  constexpr int kNumRounds = 4;  // what is left out no longer draws the middle away
  constexpr double kMinShare = 0.7;
  PointMoments all;
  for (const std::size_t i : members) all.Add(grid.Moments(i));
  PointMoments kept = all;
  std::vector<std::size_t> compact;
  for (int round = 0; round < kNumRounds; ++round) {
    const Eigen::Vector3d middle_m = kept.MeanM();
    compact.clear();
    kept = PointMoments();
    for (const std::size_t i : members) {
      if ((grid.MeanM(i) - middle_m).norm() > options.max_radius_m) continue;
      compact.push_back(i);
      kept.Add(grid.Moments(i));
    }
    if (kept.num < kMinShare * all.num) return {};
  }
  return compact;
}

bool HasBoardSize(const PlanarPatch& patch, const PatchSearchOptions& options) {
  return patch.num_points >= options.min_points && Unlikeness(patch, options) <= std::log(2.0);
}

/// The members, and what continues their plane across gaps, as far as a board may reach: scan lines
/// may be more than a cell apart, and some sensors leave parts of it out.
std::vector<std::size_t> AcrossGaps(const std::vector<std::size_t>& members,
                                    const VoxelGrid& grid,
                                    const PatchSearchOptions& options,
                                    const std::vector<CellSurface>& surfaces) {
  // Little by little: a small piece's plane is not known far from it.
  constexpr std::array<double, 3> kShares = {0.5, 0.75, 1.0};
  std::vector<std::size_t> all = members;
  std::vector<std::size_t> near;
  for (const double share : kShares) {
    const PlanarPatch piece = Describe(all, grid);
    if (piece.plane.spread_m[1] < MinWidthM(options)) break;  // a line has no plane
    near.clear();
    grid.AppendWithin(piece.middle_m, share * options.max_radius_m, &near);
    all = members;
    for (const std::size_t i : near) {
      if (Continues(piece.plane, i, grid, options, surfaces)) all.push_back(i);
    }
  }
  return all;
}

/// Of what a gap divides, which may be one board seen in pieces, or a board and what stands beside
/// it: all if that has the board's size, or else the piece at hand if it has. Empty if neither has.
std::vector<std::size_t> PieceOfBoardSize(const std::vector<std::size_t>& members,
                                          const VoxelGrid& grid,
                                          const PatchSearchOptions& options,
                                          const std::vector<CellSurface>& surfaces) {
  const std::vector<std::size_t> all = AcrossGaps(members, grid, options, surfaces);
  std::vector<std::size_t> piece = Compact(all, grid, options);
  if (HasBoardSize(Describe(piece, grid), options)) return piece;
  if (all.size() == members.size()) return {};
  piece = Compact(members, grid, options);
  if (HasBoardSize(Describe(piece, grid), options)) return piece;
  return {};
}

}  // namespace

std::vector<PlanarPatch> FindPlanarPatches(const std::vector<Eigen::Vector3d>& points_m,
                                           const PatchSearchOptions& options) {
  const VoxelGrid grid(points_m, options.voxel_m);
  std::vector<CellSurface> surfaces = FitSurfaces(grid, options);
  std::vector<PlanarPatch> patches;
  std::int32_t num_grown = 0;
  for (const std::size_t seed : SeedOrder(surfaces)) {
    if (surfaces[seed].patch != kNone) continue;
    const std::int32_t grown = num_grown++;
    const std::vector<std::size_t> members = Grow(seed, grown, grid, options, &surfaces);
    if (IsTooLarge(Describe(members, grid), options)) continue;
    const std::vector<std::size_t> piece = PieceOfBoardSize(members, grid, options, surfaces);
    if (piece.empty()) continue;
    patches.push_back(Describe(piece, grid));
    for (const std::size_t i : members) surfaces[i].patch = kNone;
    for (const std::size_t i : piece) surfaces[i].patch = grown;
  }
  std::stable_sort(patches.begin(), patches.end(), [&](const auto& a, const auto& b) {
    return Unlikeness(a, options) < Unlikeness(b, options);
  });
  return patches;
}

}  // namespace voqcal
