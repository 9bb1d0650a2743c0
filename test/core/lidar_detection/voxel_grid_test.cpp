#include "core/lidar_detection/voxel_grid.hpp"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kVoxelM = 0.2;

// A tall wall, a floor and a cloud of single points, on both sides of the origin.
std::vector<Eigen::Vector3d> Points() {
  test::Random random(3);
  std::vector<Eigen::Vector3d> points_m;
  for (int i = 0; i < 400; ++i) {
    points_m.emplace_back(1.0, random.Uniform(-2, 2), random.Uniform(-2, 3));
    points_m.emplace_back(random.Uniform(-2, 2), random.Uniform(-2, 2), -2.0);
    points_m.emplace_back(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
  }
  return points_m;
}

Eigen::Array3d CellOf(const VoxelGrid& grid, std::size_t cell) {
  return (grid.MeanM(cell).array() / kVoxelM).floor();
}

TEST(VoxelGrid, KnowsTheCellsThatTouch) {
  const VoxelGrid grid(Points(), kVoxelM);
  ASSERT_GT(grid.NumCells(), 300u);
  for (std::size_t at = 0; at < grid.NumCells(); ++at) {
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < grid.NumCells(); ++i) {
      const Eigen::Array3d steps = (CellOf(grid, i) - CellOf(grid, at)).abs();
      if ((steps <= 1).all()) expected.push_back(i);
    }
    std::vector<std::size_t> touching;
    grid.ForEachTouching(at, [&touching](std::size_t i) { touching.push_back(i); });
    ASSERT_EQ(touching, expected) << "cell " << at;
  }
}

TEST(VoxelGrid, FindsTheCellsWithinARadius) {
  const VoxelGrid grid(Points(), kVoxelM);
  test::Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    // Also beside all points.
    const Eigen::Vector3d place_m(
        random.Uniform(-3, 3), random.Uniform(-3, 3), random.Uniform(-3, 4));
    const double radius_m = random.Uniform(0.01, 2.0);
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < grid.NumCells(); ++i) {
      if ((grid.MeanM(i) - place_m).norm() <= radius_m) expected.push_back(i);
    }
    std::vector<std::size_t> within = {7};  // stays
    grid.AppendWithin(place_m, radius_m, &within);
    expected.insert(expected.begin(), 7);
    ASSERT_EQ(within, expected) << place_m.transpose() << ", radius " << radius_m;
  }
}

TEST(VoxelGrid, EndsAreNoNeighbours) {
  // As far out as cells go and farther: at both ends of the range, and beyond.
  const std::vector<Eigen::Vector3d> points_m = {{-3e5, -3e5, -3e5}, {0, 0, 0}, {3e5, 3e5, 3e5}};
  const VoxelGrid grid(points_m, kVoxelM);
  ASSERT_EQ(grid.NumCells(), 3u);
  for (std::size_t at = 0; at < 3; ++at) {
    int num_touching = 0;
    grid.ForEachTouching(at, [&num_touching](std::size_t) { ++num_touching; });
    EXPECT_EQ(num_touching, 1);
    std::vector<std::size_t> within;
    grid.AppendWithin(points_m[at], 1.0, &within);
    EXPECT_EQ(within.size(), 1u);
  }
}

TEST(VoxelGrid, KeepsEachPointOnce) {
  const std::vector<Eigen::Vector3d> points_m = Points();
  const VoxelGrid grid(points_m, kVoxelM);
  PointMoments all;
  for (std::size_t i = 0; i < grid.NumCells(); ++i) all.Add(grid.Moments(i));
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point_m : points_m) sum_m += point_m;
  EXPECT_EQ(all.num, static_cast<double>(points_m.size()));
  EXPECT_LT((all.sum_m - sum_m).norm(), 1e-9);
}

}  // namespace
}  // namespace voqcal
