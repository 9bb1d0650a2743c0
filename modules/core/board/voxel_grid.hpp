#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/board/plane_fit.hpp"

namespace voqcal {

/// Points gathered in cubes; a cell's neighbours are found without hashing.
///
/// Cells are ordered by x, y, z. Those of equal x and y form a column, and each column knows the
/// columns around it: a neighbourhood is 9 or 25 short runs of cells.
class VoxelGrid {
 public:
  VoxelGrid(const std::vector<Eigen::Vector3d>& points_m, double voxel_m);

  std::size_t NumCells() const { return places_.size(); }
  const PointMoments& Moments(std::size_t cell) const { return moments_[cell]; }
  const Eigen::Vector3d& MeanM(std::size_t cell) const { return means_m_[cell]; }

  /// Calls `visit(i)` for each cell within `reach` (at most 2) steps of cell `at`, itself included.
  template <typename Visit>
  void ForEachNear(std::size_t at, int reach, Visit visit) const {
    if (reach != 1) return ForEachInColumns(at, reach, visit);
    for (std::size_t k = touching_begin_[at]; k < touching_begin_[at + 1]; ++k) visit(touching_[k]);
  }

 private:
  static constexpr int kReach = 2;
  static constexpr std::int32_t kNoColumn = -1;

  struct Place {
    std::uint32_t column = 0;
    std::int32_t z = 0;  // height in the column, in cells
  };
  struct Column {
    std::size_t begin = 0;  // of its cells
    std::size_t end = 0;
    std::array<std::int32_t, (2 * kReach + 1) * (2 * kReach + 1)> near{};
  };

  static std::size_t NearSlot(int dx, int dy) {
    return static_cast<std::size_t>((dx + kReach) * (2 * kReach + 1) + dy + kReach);
  }

  template <typename Visit>
  void ForEachInColumns(std::size_t at, int reach, Visit visit) const {
    const Place place = places_[at];
    for (int dx = -reach; dx <= reach; ++dx) {
      for (int dy = -reach; dy <= reach; ++dy) {
        const std::int32_t near = columns_[place.column].near[NearSlot(dx, dy)];
        if (near == kNoColumn) continue;
        const Column& column = columns_[static_cast<std::size_t>(near)];
        std::size_t i = column.begin;
        while (i < column.end && places_[i].z < place.z - reach) ++i;
        for (; i < column.end && places_[i].z <= place.z + reach; ++i) visit(i);
      }
    }
  }

  void LinkColumns(const std::vector<std::uint64_t>& keys);
  void ListTouching();

  // Of each cell, by what is used together.
  std::vector<Place> places_;
  std::vector<PointMoments> moments_;
  std::vector<Eigen::Vector3d> means_m_;
  std::vector<Column> columns_;
  std::vector<std::uint32_t> touching_;      // within one step of each cell, cell by cell...
  std::vector<std::size_t> touching_begin_;  // ...from here on; they are asked for often
};

}  // namespace voqcal
