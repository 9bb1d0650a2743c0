#include "core/lidar_detection/voxel_grid.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace voqcal {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr int kBits = 21;  // for each axis: +-1 million cells, beyond any range over any cell
constexpr double kOffset = 1 << (kBits - 1);
constexpr std::uint64_t kAxisMask = (std::uint64_t{1} << kBits) - 1;

/// Places beyond the range are in its outermost cells, but for one: steps of one cell never leave
/// it.
std::uint64_t PackedAxis(double cell) {
  // Positive once the offset is added, so that the conversion rounds down.
  return static_cast<std::uint64_t>(
      std::clamp(cell + kOffset, 1.0, static_cast<double>(kAxisMask - 1)));
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

VoxelGrid::VoxelGrid(const std::vector<Eigen::Vector3d>& points_m, double voxel_m)
    : voxel_m_(voxel_m) {
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

  heights_.reserve(order.size());
  moments_.reserve(order.size());
  means_m_.reserve(order.size());
  for (const auto& [key, i] : order) {
    if (columns_.empty() || columns_.back().key != key >> kBits) {
      columns_.push_back({key >> kBits, heights_.size(), heights_.size()});
    }
    heights_.push_back(static_cast<std::int32_t>(key & kAxisMask));
    moments_.push_back(moments[i]);
    means_m_.push_back(moments[i].MeanM());
    columns_.back().end = heights_.size();
  }
  ListTouching();
}

void VoxelGrid::ListTouching() {
  // Cells of a column that touches the one at hand, or of that itself.
  struct Run {
    std::size_t first;
    std::size_t end;
  };
  touching_.reserve(16 * NumCells());
  touching_begin_.reserve(NumCells() + 1);
  touching_begin_.push_back(0);
  std::array<std::size_t, 3> next{};  // the first column that can touch, for each step in x
  for (const Column& column : columns_) {
    std::array<Run, 9> runs;
    std::size_t num_runs = 0;
    for (std::size_t dx = 0; dx < next.size(); ++dx) {
      const std::uint64_t beside = column.key + (dx << kBits) - (std::uint64_t{1} << kBits);
      while (next[dx] < columns_.size() && columns_[next[dx]].key + 1 < beside) ++next[dx];
      for (std::size_t j = next[dx]; j < columns_.size() && columns_[j].key <= beside + 1; ++j) {
        runs[num_runs++] = {columns_[j].begin, columns_[j].end};
      }
    }
    // Upwards in the column, the first cell that touches moves up too, in each column beside.
    for (std::size_t at = column.begin; at < column.end; ++at) {
      for (std::size_t k = 0; k < num_runs; ++k) {
        Run& run = runs[k];
        while (run.first < run.end && heights_[run.first] < heights_[at] - 1) ++run.first;
        for (std::size_t i = run.first; i < run.end && heights_[i] <= heights_[at] + 1; ++i) {
          touching_.push_back(static_cast<std::uint32_t>(i));
        }
      }
      touching_begin_.push_back(touching_.size());
    }
  }
}

void VoxelGrid::AppendWithin(const Eigen::Vector3d& place_m,
                             double radius_m,
                             std::vector<std::size_t>* cells) const {
  const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(radius_m);
  const std::uint64_t lowest = KeyOf(place_m - reach_m, 1.0 / voxel_m_);
  const std::uint64_t highest = KeyOf(place_m + reach_m, 1.0 / voxel_m_);
  const auto lowest_height = static_cast<std::int32_t>(lowest & kAxisMask);
  const auto highest_height = static_cast<std::int32_t>(highest & kAxisMask);
  const std::uint64_t row_length = (highest >> kBits & kAxisMask) - (lowest >> kBits & kAxisMask);
  const std::uint64_t num_rows = (highest >> 2 * kBits) - (lowest >> 2 * kBits) + 1;
  const auto is_before = [](const Column& column, std::uint64_t key) { return column.key < key; };
  auto column = columns_.begin();
  for (std::uint64_t row = 0; row < num_rows; ++row) {
    const std::uint64_t row_begin = (lowest >> kBits) + (row << kBits);
    column = std::lower_bound(column, columns_.end(), row_begin, is_before);
    if (column == columns_.end()) return;
    for (; column != columns_.end() && column->key <= row_begin + row_length; ++column) {
      std::size_t i = column->begin;
      while (i < column->end && heights_[i] < lowest_height) ++i;
      for (; i < column->end && heights_[i] <= highest_height; ++i) {
        if ((means_m_[i] - place_m).squaredNorm() <= radius_m * radius_m) cells->push_back(i);
      }
    }
  }
}

}  // namespace voqcal
