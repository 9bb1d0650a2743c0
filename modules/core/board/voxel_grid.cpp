#include "core/board/voxel_grid.hpp"

#include <algorithm>
#include <utility>

namespace voqcal {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr int kBits = 21;  // for each axis: +-1 million cells, beyond any range over any cell
constexpr double kOffset = 1 << (kBits - 1);
constexpr std::uint64_t kAxisMask = (std::uint64_t{1} << kBits) - 1;

std::uint64_t PackedAxis(double cell) {
  // Positive once the offset is added, so that the conversion rounds down.
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(cell + kOffset)) & kAxisMask;
}

/// Orders like (x, y, z).
std::uint64_t KeyOf(const Eigen::Vector3d& point_m, double per_voxel) {
  return PackedAxis(point_m.x() * per_voxel) << (2 * kBits) |
         PackedAxis(point_m.y() * per_voxel) << kBits | PackedAxis(point_m.z() * per_voxel);
}

/// From key to number: open addressing, at most half full. Several times faster than
/// std::unordered_map here.
class KeyTable {
 public:
  /// The number of `key`; a new key gets the next one.
  std::uint32_t NumberOf(std::uint64_t key) {
    std::size_t i = SlotOf(key);
    if (slots_[i].second != kNone) return slots_[i].second;
    if (2 * keys_.size() >= slots_.size()) {
      Double();
      i = SlotOf(key);
    }
    slots_[i] = {key, static_cast<std::uint32_t>(keys_.size())};
    keys_.push_back(key);
    return slots_[i].second;
  }

  const std::vector<std::uint64_t>& Keys() const { return keys_; }

 private:
  using Slot = std::pair<std::uint64_t, std::uint32_t>;

  /// Where `key` is, or where it would go.
  std::size_t SlotOf(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = (key * 0x9E3779B97F4A7C15U >> 32) & mask;  // Fibonacci hashing, TAOCP 3, 6.4
    while (slots_[i].second != kNone && slots_[i].first != key) i = (i + 1) & mask;
    return i;
  }

  void Double() {
    slots_.assign(2 * slots_.size(), {0, kNone});
    for (std::uint32_t n = 0; n < keys_.size(); ++n) slots_[SlotOf(keys_[n])] = {keys_[n], n};
  }

  std::vector<Slot> slots_ = std::vector<Slot>(4096, {0, kNone});
  std::vector<std::uint64_t> keys_;
};

}  // namespace

VoxelGrid::VoxelGrid(const std::vector<Eigen::Vector3d>& points_m, double voxel_m) {
  KeyTable table;
  std::vector<PointMoments> moments;
  for (const Eigen::Vector3d& point_m : points_m) {
    const std::uint32_t cell = table.NumberOf(KeyOf(point_m, 1.0 / voxel_m));
    if (cell == moments.size()) moments.emplace_back();
    moments[cell].Add(point_m);
  }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(moments.size());
  for (std::uint32_t i = 0; i < moments.size(); ++i) order.emplace_back(table.Keys()[i], i);
  std::sort(order.begin(), order.end());

  places_.reserve(order.size());
  moments_.reserve(order.size());
  means_m_.reserve(order.size());
  std::vector<std::uint64_t> column_keys;
  for (const auto& [key, i] : order) {
    if (column_keys.empty() || column_keys.back() != key >> kBits) {
      column_keys.push_back(key >> kBits);
      columns_.emplace_back().begin = places_.size();
    }
    const auto column = static_cast<std::uint32_t>(columns_.size() - 1);
    places_.push_back({column, static_cast<std::int32_t>(key & kAxisMask)});
    moments_.push_back(moments[i]);
    means_m_.push_back(moments[i].MeanM());
    columns_.back().end = places_.size();
  }
  LinkColumns(column_keys);
  ListTouching();
}

void VoxelGrid::LinkColumns(const std::vector<std::uint64_t>& keys) {
  // Keys grow, so for each dx the first column that can be near moves on only.
  for (int dx = -kReach; dx <= kReach; ++dx) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const std::int64_t row = static_cast<std::int64_t>(keys[i]) + dx * (std::int64_t{1} << kBits);
      const auto dy_of = [&](std::size_t j) { return static_cast<std::int64_t>(keys[j]) - row; };
      while (first < keys.size() && dy_of(first) < -kReach) ++first;
      for (int dy = -kReach; dy <= kReach; ++dy) columns_[i].near[NearSlot(dx, dy)] = kNoColumn;
      for (std::size_t j = first; j < keys.size() && dy_of(j) <= kReach; ++j) {
        columns_[i].near[NearSlot(dx, static_cast<int>(dy_of(j)))] = static_cast<std::int32_t>(j);
      }
    }
  }
}

void VoxelGrid::ListTouching() {
  touching_.reserve(16 * NumCells());
  touching_begin_.reserve(NumCells() + 1);
  touching_begin_.push_back(0);
  for (const Column& column : columns_) {
    // Upwards in the column, the first cell that touches moves up too, in each column around.
    struct Run {
      std::size_t first;
      std::size_t end;
    };
    std::array<Run, 9> runs;
    std::size_t num_runs = 0;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const std::int32_t near = column.near[NearSlot(dx, dy)];
        if (near == kNoColumn) continue;
        const Column& beside = columns_[static_cast<std::size_t>(near)];
        runs[num_runs++] = {beside.begin, beside.end};
      }
    }
    for (std::size_t at = column.begin; at < column.end; ++at) {
      const std::int32_t z = places_[at].z;
      for (std::size_t k = 0; k < num_runs; ++k) {
        Run& run = runs[k];
        while (run.first < run.end && places_[run.first].z < z - 1) ++run.first;
        for (std::size_t i = run.first; i < run.end && places_[i].z <= z + 1; ++i) {
          touching_.push_back(static_cast<std::uint32_t>(i));
        }
      }
      touching_begin_.push_back(touching_.size());
    }
  }
}

}  // namespace voqcal
