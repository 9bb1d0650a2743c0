#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/lidar/plane_fit.hpp"

namespace voqcal {

/// Points gathered in cubes; the neighbours of a cell are found without hashing.
///
/// Cells are ordered by x, y, z. Those of equal x and y form a column.
class VoxelGrid {
 public:
  VoxelGrid(const std::vector<Eigen::Vector3d>& points_m, double voxel_m);

  std::size_t NumCells() const { return heights_.size(); }
  const PointMoments& Moments(std::size_t cell) const { return moments_[cell]; }
  const Eigen::Vector3d& MeanM(std::size_t cell) const { return means_m_[cell]; }

  /// Calls `visit(i)` for each cell that touches cell `at`, itself included.
  template <typename Visit>
  void ForEachTouching(std::size_t at, Visit visit) const {
    for (std::size_t k = touching_begin_[at]; k < touching_begin_[at + 1]; ++k) visit(touching_[k]);
  }

  /// Appends the cells whose means lie within `radius_m` of a place.
  void AppendWithin(const Eigen::Vector3d& place_m,
                    double radius_m,
                    std::vector<std::size_t>* cells) const;

 private:
  struct Column {
    std::uint64_t key = 0;  // of its x and y
    std::size_t begin = 0;  // of its cells
    std::size_t end = 0;
  };

  void ListTouching();

  double voxel_m_;
  // Of each cell, by what is used together.
  std::vector<std::int32_t> heights_;  // in the column, in cells from far below
  std::vector<PointMoments> moments_;
  std::vector<Eigen::Vector3d> means_m_;
  std::vector<Column> columns_;              // by key
  std::vector<std::uint32_t> touching_;      // those of each cell, cell by cell...
  std::vector<std::size_t> touching_begin_;  // ...from here on; they are asked for often
};

}  // namespace voqcal
