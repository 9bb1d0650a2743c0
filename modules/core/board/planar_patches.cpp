#include "core/board/planar_patches.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>

namespace voqcal {
namespace {

constexpr std::int32_t kNone = -1;

/// Integer coordinates of a cell, and their packed key.
struct CellIndex {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;

  // 21 bits each: +-1 million cells, far beyond any range divided by any cell.
  std::uint64_t Key() const {
    const auto bits = [](std::int64_t v) {
      return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1FFFFF;
    };
    return bits(x) << 42 | bits(y) << 21 | bits(z);
  }
};

struct Cell {
  CellIndex index;
  PointMoments moments;
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  PlaneFit surface;  // of the 3 x 3 x 3 cells around it
  bool is_planar = false;
  std::int32_t patch = kNone;
};

/// From key to cell: open addressing, a power of two slots. About five times faster than
/// std::unordered_map here, and lookups are what the search spends its time on.
class CellTable {
 public:
  explicit CellTable(std::size_t max_cells) {
    std::size_t num_slots = 64;
    while (num_slots < 2 * max_cells) num_slots *= 2;
    slots_.resize(num_slots, {0, kNone});
  }

  /// The slot of `key`: its value is kNone if the key is new.
  std::int32_t& Slot(std::uint64_t key) {
    std::size_t i = Home(key);
    while (slots_[i].second != kNone && slots_[i].first != key) i = (i + 1) & (slots_.size() - 1);
    slots_[i].first = key;
    return slots_[i].second;
  }

  std::int32_t Find(std::uint64_t key) const {
    std::size_t i = Home(key);
    while (slots_[i].second != kNone && slots_[i].first != key) i = (i + 1) & (slots_.size() - 1);
    return slots_[i].second;
  }

 private:
  std::size_t Home(std::uint64_t key) const {
    key *= 0x9E3779B97F4A7C15U;  // Fibonacci hashing (Knuth, TAOCP 3, 6.4)
    return (key >> 32) & (slots_.size() - 1);
  }

  std::vector<std::pair<std::uint64_t, std::int32_t>> slots_;
};

struct Grid {
  std::vector<Cell> cells;
  CellTable table;

  /// Calls `visit` with each cell within `reach` steps, itself included.
  template <typename Visit>
  void ForEachNear(const CellIndex& at, int reach, Visit visit) const {
    for (int dx = -reach; dx <= reach; ++dx) {
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dz = -reach; dz <= reach; ++dz) {
          const std::int32_t i = table.Find(CellIndex{at.x + dx, at.y + dy, at.z + dz}.Key());
          if (i != kNone) visit(static_cast<std::size_t>(i));
        }
      }
    }
  }
};

Grid FillGrid(const std::vector<Eigen::Vector3d>& points_m, double voxel_m) {
  Grid grid{{}, CellTable(points_m.size())};
  for (const Eigen::Vector3d& point_m : points_m) {
    const Eigen::Vector3d scaled = (point_m / voxel_m).array().floor();
    const CellIndex index{static_cast<std::int64_t>(scaled.x()),
                          static_cast<std::int64_t>(scaled.y()),
                          static_cast<std::int64_t>(scaled.z())};
    std::int32_t& slot = grid.table.Slot(index.Key());
    if (slot == kNone) {
      slot = static_cast<std::int32_t>(grid.cells.size());
      grid.cells.emplace_back().index = index;
    }
    grid.cells[static_cast<std::size_t>(slot)].moments.Add(point_m);
  }
  for (Cell& cell : grid.cells) cell.mean_m = cell.moments.MeanM();
  return grid;
}

/// Fits a surface to the surroundings of each cell.
void FitSurfaces(const PatchSearchOptions& options, Grid* grid) {
  constexpr double kMinPoints = 12;  // two scan lines of six points
  for (Cell& cell : grid->cells) {
    PointMoments around;
    grid->ForEachNear(cell.index, 1, [&](std::size_t i) { around.Add(grid->cells[i].moments); });
    if (around.num < kMinPoints) continue;
    cell.surface = FitPlane(around);
    // Noise of 10 mm and scan lines up to 30 mm apart give at most about 20 mm (1 sigma); a single
    // scan line spreads along one axis only.
    cell.is_planar = cell.surface.spread_m[0] < options.band_m / 2 &&
                     cell.surface.spread_m[1] > options.voxel_m / 5;
  }
}

/// Flattest first; ties by place, so that the points' order does not matter.
std::vector<std::size_t> SeedOrder(const Grid& grid) {
  std::vector<std::size_t> seeds;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (grid.cells[i].is_planar) seeds.push_back(i);
  }
  const auto rank = [&grid](std::size_t i) {
    const Cell& cell = grid.cells[i];
    // To 0.1 mm: the rounding of sums must not decide.
    return std::make_tuple(std::lround(cell.surface.spread_m[0] * 1e4), cell.index.Key());
  };
  std::sort(seeds.begin(), seeds.end(), [&](auto a, auto b) { return rank(a) < rank(b); });
  return seeds;
}

/// All cells that continue the seed's plane without a gap of more than one cell (far away, scan
/// lines are more than a cell apart).
std::vector<std::size_t> Grow(std::size_t seed,
                              std::int32_t patch,
                              const PatchSearchOptions& options,
                              Grid* grid) {
  constexpr double kMinNormalCosine = 0.9;  // 26 degrees: surfaces of small cells are rough
  PlaneFit plane = grid->cells[seed].surface;
  PointMoments moments;
  std::size_t num_at_fit = 27;  // the surface is about as good as this many cells
  std::vector<std::size_t> members = {seed};
  grid->cells[seed].patch = patch;
  for (std::size_t next = 0; next < members.size(); ++next) {
    moments.Add(grid->cells[members[next]].moments);
    if (next >= 2 * num_at_fit) {
      plane = FitPlane(moments);
      num_at_fit = next;
    }
    grid->ForEachNear(grid->cells[members[next]].index, 2, [&](std::size_t i) {
      Cell& cell = grid->cells[i];
      if (cell.patch != kNone || std::abs(plane.DistanceM(cell.mean_m)) > options.band_m) return;
      if (cell.is_planar && std::abs(cell.surface.normal.dot(plane.normal)) < kMinNormalCosine)
        return;
      cell.patch = patch;
      members.push_back(i);
    });
  }
  return members;
}

PlanarPatch Describe(const std::vector<std::size_t>& members, const Grid& grid) {
  PlanarPatch patch;
  PointMoments moments;
  for (const std::size_t i : members) {
    moments.Add(grid.cells[i].moments);
    patch.middle_m += grid.cells[i].mean_m / static_cast<double>(members.size());
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

bool HasBoardSize(const PlanarPatch& patch,
                  const std::vector<std::size_t>& members,
                  const Grid& grid,
                  const PatchSearchOptions& options) {
  if (patch.num_points < options.min_points) return false;
  if (Unlikeness(patch, options) > std::log(2.0)) return false;
  return std::all_of(members.begin(), members.end(), [&](std::size_t i) {
    return (grid.cells[i].mean_m - patch.middle_m).norm() <= options.max_radius_m;
  });
}

}  // namespace

std::vector<PlanarPatch> FindPlanarPatches(const std::vector<Eigen::Vector3d>& points_m,
                                           const PatchSearchOptions& options) {
  Grid grid = FillGrid(points_m, options.voxel_m);
  FitSurfaces(options, &grid);
  std::vector<PlanarPatch> patches;
  std::int32_t num_grown = 0;
  for (const std::size_t seed : SeedOrder(grid)) {
    if (grid.cells[seed].patch != kNone) continue;
    const std::vector<std::size_t> members = Grow(seed, num_grown++, options, &grid);
    const PlanarPatch patch = Describe(members, grid);
    if (HasBoardSize(patch, members, grid, options)) patches.push_back(patch);
  }
  std::stable_sort(patches.begin(), patches.end(), [&](const auto& a, const auto& b) {
    return Unlikeness(a, options) < Unlikeness(b, options);
  });
  return patches;
}

}  // namespace voqcal
