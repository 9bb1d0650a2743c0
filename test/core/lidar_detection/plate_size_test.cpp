#include "core/lidar_detection/plate_size.hpp"

#include <gtest/gtest.h>

#include "support/sanitizers.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

using test::FacingBoard;
using test::SynthesizeLidarBoard;
using test::SyntheticBox;
using test::SyntheticLidarBoardOptions;

/// A plate at four places, before a cupboard of another size that stays.
std::vector<PointCloud> Sweeps(bool has_board) {
  SyntheticLidarBoardOptions scene;
  scene.noise_m = 0.005;
  scene.num_rings = 32;
  scene.step_deg = 0.4;
  scene.has_board = has_board;
  SyntheticBox cupboard;
  cupboard.T_lidar_box.translation() = Eigen::Vector3d(4.0, 2.5, 0.0);
  cupboard.half_m = {0.3, 0.45, 0.35};
  scene.boxes.push_back(cupboard);
  std::vector<PointCloud> sweeps;
  for (const double roll_deg : {10.0, 40.0, 65.0, -20.0}) {
    scene.T_lidar_board = FacingBoard({2.0 + roll_deg / 100, roll_deg / 50, 0.0}, roll_deg, 10.0);
    scene.seed += 1;
    sweeps.push_back(SynthesizeLidarBoard(scene));
  }
  return sweeps;
}

BoardSpec Pattern() {
  BoardSpec pattern = SyntheticLidarBoardOptions{}.board;
  pattern.width_m = pattern.height_m = 0.0;
  return pattern;
}

// An edge is measured to 2 mm in a sweep, 5 mm spill being known to 4.
TEST(MeasurePlateSize, IsThatOfWhatMoves) {
  VOQCAL_LEAVE_TO_RELEASE();
  const auto size = MeasurePlateSize(Sweeps(true), Pattern(), {});
  ASSERT_TRUE(size);
  EXPECT_EQ(size->num_places, 4);
  EXPECT_NEAR(size->longer_m, 0.85, 0.01);
  EXPECT_NEAR(size->shorter_m, 0.61, 0.01);
  EXPECT_GT(size->sigma_m, 0.008);  // of the spill past two sides
  EXPECT_LT(size->sigma_m, 0.012);
}

TEST(MeasurePlateSize, IsUnknownWhereNothingMoves) {
  VOQCAL_LEAVE_TO_RELEASE();
  EXPECT_FALSE(MeasurePlateSize(Sweeps(false), Pattern(), {}));
  EXPECT_FALSE(MeasurePlateSize({}, Pattern(), {}));
}

}  // namespace
}  // namespace voqcal
