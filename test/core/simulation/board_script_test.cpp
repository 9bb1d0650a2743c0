#include "core/simulation/board_script.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/rigid.hpp"
#include "core/units.hpp"
#include "simulated_rig.hpp"

namespace voqcal {
namespace {

std::vector<Eigen::Isometry3d> StopsOf(const test::SimulatedRig& rig) {
  const BoardScript script(rig.options, rig.board, rig.camera, Room());
  std::vector<Eigen::Isometry3d> stops;
  for (int i = 0; i < rig.options.num_poses; ++i) {
    stops.push_back(script.T_lidar_board(test::TimeAtStopS(rig.options, i)));
  }
  return stops;
}

class BoardScriptOfLens : public testing::TestWithParam<LensModel> {};

TEST_P(BoardScriptOfLens, ShowsTheWholeBoardToBothSensorsAtEveryStop) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    test::SimulatedRig rig = test::CleanRig(GetParam());
    rig.options.seed = seed;
    rig.options.num_poses = 40;
    for (const Eigen::Isometry3d& T_lidar_board : StopsOf(rig)) {
      const Eigen::Isometry3d T_camera_board = rig.options.T_camera_lidar * T_lidar_board;
      for (const Eigen::Vector3d& corner : rig.board.OutlineBoardM()) {
        const Eigen::Vector3d in_lidar_m = T_lidar_board * corner;
        EXPECT_LT(std::abs(in_lidar_m.z()),
                  std::tan(15 * kRadPerDeg) * std::hypot(in_lidar_m.x(), in_lidar_m.y()));
        EXPECT_GT(in_lidar_m.z(), -1.2 + 0.1);
        ASSERT_TRUE(rig.camera.IsInFront(T_camera_board * corner));
        const Eigen::Vector2d pixel = rig.camera.Project<double>(T_camera_board * corner);
        EXPECT_GT(pixel.minCoeff(), 5.0);
        EXPECT_LT(pixel.x(), rig.camera.width_px - 6.0);
        EXPECT_LT(pixel.y(), rig.camera.height_px - 6.0);
      }
      // Seen from the front by both.
      EXPECT_GT(T_lidar_board.inverse().translation().z(), 0.5);
      EXPECT_GT(T_camera_board.inverse().translation().z(), 0.5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllLenses,
                         BoardScriptOfLens,
                         testing::Values(LensModel::kEquidistant,
                                         LensModel::kPlumbBob,
                                         LensModel::kRational));

TEST(BoardScript, HoldsTheBoardAsATiltedDiamond) {
  test::SimulatedRig rig = test::CleanRig();
  rig.options.num_poses = 40;
  double largest_yaw_rad = 0.0;
  double largest_pitch_rad = 0.0;
  for (const Eigen::Isometry3d& T_lidar_board : StopsOf(rig)) {
    // Upright board axes from the direction of its centre; R = Ry(yaw) Rx(pitch) Rz(roll).
    const Eigen::Vector3d z =
        -Eigen::Vector3d(T_lidar_board(0, 3), T_lidar_board(1, 3), 0).normalized();
    Eigen::Matrix3d R_upright;
    R_upright << Eigen::Vector3d::UnitZ().cross(z), Eigen::Vector3d::UnitZ(), z;
    const Eigen::Matrix3d R = R_upright.transpose() * T_lidar_board.linear();
    const double roll_rad = std::atan2(R(1, 0), R(1, 1));
    const double pitch_rad = std::asin(-R(1, 2));
    const double yaw_rad = std::atan2(R(0, 2), R(2, 2));
    EXPECT_NEAR(roll_rad, 45 * kRadPerDeg, 15 * kRadPerDeg);
    EXPECT_NEAR(pitch_rad, 0.0, 40 * kRadPerDeg);
    EXPECT_NEAR(yaw_rad, 0.0, 40 * kRadPerDeg);
    largest_yaw_rad = std::max(largest_yaw_rad, std::abs(yaw_rad));
    largest_pitch_rad = std::max(largest_pitch_rad, std::abs(pitch_rad));
  }
  EXPECT_GT(largest_yaw_rad, 30 * kRadPerDeg);
  EXPECT_GT(largest_pitch_rad, 30 * kRadPerDeg);
}

TEST(BoardScript, SpreadsStopsOverImageAndDistances) {
  test::SimulatedRig rig = test::CleanRig();
  rig.options.num_poses = 40;
  std::vector<double> columns_px;
  std::vector<double> distances_m;
  for (const Eigen::Isometry3d& T_lidar_board : StopsOf(rig)) {
    const Eigen::Vector3d centre_m = T_lidar_board.translation();
    columns_px.push_back(rig.camera.Project<double>(rig.options.T_camera_lidar * centre_m).x());
    distances_m.push_back(centre_m.norm());
  }
  const auto [left, right] = std::minmax_element(columns_px.begin(), columns_px.end());
  EXPECT_GT(*right - *left, 0.6 * rig.camera.width_px);
  const auto [near, far] = std::minmax_element(distances_m.begin(), distances_m.end());
  EXPECT_GE(*near, rig.options.min_distance_m);
  EXPECT_LE(*far, rig.options.max_distance_m);
  EXPECT_LT(*near, 2.2);  // nearer, the board does not fit between the beams in most orientations
  EXPECT_GT(*far, 4.0);
}

TEST(BoardScript, RestsExactlyAtStopsAndMovesSmoothlyBetween) {
  const test::SimulatedRig rig = test::CleanRig();
  const BoardScript script(rig.options, rig.board, rig.camera, Room());
  EXPECT_DOUBLE_EQ(script.DurationS(), 8 * 1.0 + 7 * 0.5);
  for (int stop = 0; stop < rig.options.num_poses; ++stop) {
    const double begin_s = stop * 1.5 + 1e-6;
    EXPECT_TRUE(script.IsStill(begin_s));
    EXPECT_TRUE(script.IsStill(begin_s + 0.99));
    EXPECT_EQ(script.T_lidar_board(begin_s).matrix(),
              script.T_lidar_board(begin_s + 0.99).matrix());
    if (stop + 1 == rig.options.num_poses) break;
    EXPECT_FALSE(script.IsStill(begin_s + 1.25));
    EXPECT_GT((script.T_lidar_board(begin_s + 1.25).translation() -
               script.T_lidar_board(begin_s).translation())
                  .norm(),
              1e-3);
  }
  // The quintic's greatest speed is 15/8 of the mean speed; a move is at most 10 m and 2 rad long.
  const double step_s = 1e-3;
  const double share = 15.0 / 8.0 * step_s / rig.options.move_s;
  for (double time_s = 0.0; time_s < script.DurationS(); time_s += step_s) {
    const Eigen::Isometry3d T_before = script.T_lidar_board(time_s);
    const Eigen::Isometry3d T_after = script.T_lidar_board(time_s + step_s);
    ASSERT_LT((T_after.translation() - T_before.translation()).norm(), 10.0 * share);
    ASSERT_LT(RotationAngleBetween(T_before.linear(), T_after.linear()), 4.0 * share);
  }
}

TEST(BoardScript, HoldsTheEndsOutsideItsDuration) {
  const test::SimulatedRig rig = test::CleanRig();
  const BoardScript script(rig.options, rig.board, rig.camera, Room());
  EXPECT_EQ(script.T_lidar_board(-5.0).matrix(), script.T_lidar_board(0.0).matrix());
  EXPECT_EQ(script.T_lidar_board(script.DurationS() + 5.0).matrix(),
            script.T_lidar_board(script.DurationS()).matrix());
  EXPECT_TRUE(script.IsStill(-5.0));
  EXPECT_TRUE(script.IsStill(script.DurationS() + 5.0));
}

TEST(BoardScript, RefusesDistancesThatFitNowhere) {
  test::SimulatedRig rig = test::CleanRig();
  rig.options.min_distance_m = 20.0;
  rig.options.max_distance_m = 30.0;
  try {
    const BoardScript script(rig.options, rig.board, rig.camera, Room());
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no place for stop 1 of 8: at 20 to 30 m"));
  }
}

}  // namespace
}  // namespace voqcal
