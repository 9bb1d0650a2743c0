#include "core/simulation/guided_board.hpp"

#include <gtest/gtest.h>

#include "core/geometry/rigid.hpp"
#include "core/simulation/board_path.hpp"
#include "core/simulation/simulated_rig.hpp"
#include "support/sanitizers.hpp"

namespace voqcal {
namespace {

class GuidedBoardTest : public ::testing::Test {
 protected:
  // Another stop of the script: a place where the board can be.
  Eigen::Isometry3d AskedCamera(int stop) const {
    return rig_.options.T_camera_lidar *
           simulation_.T_lidar_board(test::TimeAtStopS(rig_.options, stop));
  }
  Eigen::Isometry3d At(double time_s) const { return PoseAt(time_s, board_.stops(), rig_.options); }

  static const test::SimulatedRig& Rig() {
    static const test::SimulatedRig rig = test::CleanRig();
    return rig;
  }
  static const Simulation& World() {  // once: it takes a while to paint
    static const Simulation world(Rig().options, Rig().board, test::HalfSize(Rig().camera));
    return world;
  }

  const test::SimulatedRig& rig_ = Rig();
  const Simulation& simulation_ = World();
  GuidedBoard board_{rig_.options, simulation_};
};

TEST(BoardPlace, IsThatOfItsPose) {
  BoardPlace place;
  place << 0.7, -0.1, 3.2, 0.5, -0.4, 0.8;
  EXPECT_LT((PlaceOf(PoseOf(place)) - place).norm(), 1e-12);
}

TEST_F(GuidedBoardTest, RestsWhileNothingIsAsked) {
  VOQCAL_LEAVE_TO_RELEASE();
  board_.DecideUntil(100.0);
  EXPECT_EQ(board_.stops().size(), 1U);
  EXPECT_EQ(At(99.0).matrix(), simulation_.T_lidar_board(0.0).matrix());
  EXPECT_FALSE(board_.end_s());
}

TEST_F(GuidedBoardTest, GoesAboutWhereItIsAskedOnceItHasRested) {
  const Eigen::Isometry3d asked = AskedCamera(1);
  board_.Ask(1, asked);
  board_.DecideUntil(0.5 * rig_.options.hold_s);
  EXPECT_EQ(board_.stops().size(), 1U);
  board_.DecideUntil(1.5 * rig_.options.hold_s);
  ASSERT_EQ(board_.stops().size(), 2U);
  EXPECT_DOUBLE_EQ(board_.stops()[1].leave_s, rig_.options.hold_s);
  const Eigen::Isometry3d held = rig_.options.T_camera_lidar * At(99.0);
  // 0.2 m and 10 degrees RMS; where the room has no place for that, a few times as much.
  EXPECT_LT((held.translation() - asked.translation()).norm(), 1.0);
  EXPECT_LT(RotationAngleBetween(held.linear(), asked.linear()), 0.8);
  EXPECT_TRUE(simulation_.CanRestAt(At(99.0)));
}

TEST_F(GuidedBoardTest, NeverChangesWhatWasDecided) {
  board_.Ask(1, AskedCamera(1));
  board_.DecideUntil(3.0);
  const Eigen::Matrix4d before = At(2.9).matrix();
  board_.Ask(2, AskedCamera(2));
  board_.DecideUntil(9.0);
  EXPECT_EQ(At(2.9).matrix(), before);
  EXPECT_GE(board_.stops().at(2).leave_s, 3.0);
}

TEST_F(GuidedBoardTest, TriesNearbyIfNothingElseIsAskedForLong) {
  board_.Ask(1, AskedCamera(1));
  for (double time_s = 0.1; time_s < 6.0; time_s += 0.1) board_.DecideUntil(time_s);
  EXPECT_EQ(board_.stops().size(), 2U);
  for (double time_s = 6.0; time_s < 9.0; time_s += 0.1) board_.DecideUntil(time_s);
  EXPECT_EQ(board_.stops().size(), 3U);
}

TEST_F(GuidedBoardTest, MovesSmoothlyAndArrivesAfterItsMove) {
  board_.Ask(1, AskedCamera(1));
  for (double time_s = 0.1; time_s < 4.0; time_s += 0.1) board_.DecideUntil(time_s);
  const double leave_s = board_.stops().at(1).leave_s;
  EXPECT_EQ(At(leave_s - 1e-6).matrix(), At(0.0).matrix());
  EXPECT_EQ(At(leave_s + rig_.options.move_s).matrix(), board_.stops()[1].T_lidar_board.matrix());
  constexpr double kStepS = 0.01;
  const double way_m =
      (board_.stops()[1].T_lidar_board.translation() - At(0.0).translation()).norm();
  for (double t_s = leave_s; t_s < leave_s + rig_.options.move_s; t_s += kStepS) {
    // Its highest speed is 15/8 of the mean; an arc is longer than its chord, by at most pi / 2.
    EXPECT_LT((At(t_s + kStepS).translation() - At(t_s).translation()).norm(),
              3.0 * way_m * kStepS / rig_.options.move_s);
  }
}

TEST_F(GuidedBoardTest, EndsWhenItIsEnoughAndTheBoardHasRested) {
  board_.Ask(1, AskedCamera(1));
  board_.DecideUntil(1.2 * rig_.options.hold_s);
  board_.Dismiss();
  const double arrival_s = board_.stops().at(1).leave_s + rig_.options.move_s;
  board_.DecideUntil(arrival_s + 0.5 * rig_.options.hold_s);
  EXPECT_FALSE(board_.end_s());
  board_.DecideUntil(arrival_s + 1.5 * rig_.options.hold_s);
  ASSERT_TRUE(board_.end_s());
  EXPECT_DOUBLE_EQ(*board_.end_s(), arrival_s + 1.5 * rig_.options.hold_s);
}

TEST_F(GuidedBoardTest, EndsAfterSoManyStops) {
  for (int i = 1; i < 200; ++i) {
    board_.Ask(i, AskedCamera(i % 2));
    board_.DecideUntil(i);
  }
  EXPECT_TRUE(board_.end_s());
  EXPECT_EQ(static_cast<int>(board_.stops().size()), rig_.options.num_poses);
}

// A detector that never finds the board: nothing new is ever asked.
TEST_F(GuidedBoardTest, EndsAfterSoManyStopsThoughTheSameIsAsked) {
  board_.Ask(1, AskedCamera(1));
  const double longest_stop_s = 2 * rig_.options.hold_s + rig_.options.move_s + 10.0;
  for (double time_s = 1.0; time_s < rig_.options.num_poses * longest_stop_s; time_s += 1.0) {
    board_.DecideUntil(time_s);
  }
  EXPECT_TRUE(board_.end_s());
  EXPECT_EQ(static_cast<int>(board_.stops().size()), rig_.options.num_poses);
}

}  // namespace
}  // namespace voqcal
