#include "sample_collector/second_look.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/convert_points.hpp"
#include "modules/nodes/node_test.hpp"
#include "support/synthetic_lidar_board.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kStopUs = 1'000'000;

// The camera looks where the lidar's x points.
Eigen::Isometry3d CameraFromLidar() {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  T_camera_lidar.translation() = Eigen::Vector3d(0.05, -0.1, -0.03);
  return T_camera_lidar;
}

Matrix6d Covariance() { return 0.01 * 0.01 * Matrix6d::Identity(); }

class SecondLookTest : public ::testing::Test {
 protected:
  SecondLookTest() {
    rig_.board = test::SyntheticLidarBoardOptions{}.board;
    look_ = SecondLook(rig_);
  }

  // The board rests for one frame at a place of its own; the lidar takes a door for it, and it if
  // `is_unsure`.
  void ShowStop(int stop, bool is_unsure) {
    test::SyntheticLidarBoardOptions scene;
    scene.T_lidar_board = test::FacingBoard(
        {2.0 + 0.2 * stop, 0.3 * stop - 0.7, 0.1 * (stop % 3)}, 45, 15 - 6 * stop, 5 * stop - 15);
    scene.noise_m = 0.005;
    scene.seed = static_cast<std::uint32_t>(stop + 1);
    truth_.push_back(scene.T_lidar_board);
    const std::int64_t utime = stop * kStopUs;
    const pointcloud2_t sweep = ToMessage(test::SynthesizeLidarBoard(scene), utime, stop);
    SensorFrame frame{utime, {}};
    frame.bytes.resize(static_cast<std::size_t>(sweep.getEncodedSize()));
    sweep.encode(frame.bytes.data(), 0, static_cast<int>(frame.bytes.size()));
    sweeps_.Add(frame);

    UnsureStop unsure;
    unsure.camera.resize(1);
    unsure.camera[0].utime = utime;
    unsure.camera[0].board.emplace();
    unsure.camera[0].board->pose =
        PoseFromTransform(CameraFromLidar() * scene.T_lidar_board, rig_.board);
    unsure.camera[0].board->pose.covariance = Covariance();
    unsure.lidar.resize(1);
    unsure.lidar[0].utime = utime;
    LidarBoard door;
    door.pose = PoseFromTransform(test::FacingBoard({4, 2, 0}, 0), rig_.board);
    door.pose.covariance = Covariance();
    unsure.lidar[0].unsure.push_back(door);
    LidarBoard board = door;
    board.pose = PoseFromTransform(scene.T_lidar_board, rig_.board);
    board.pose.covariance = Covariance();
    if (is_unsure) unsure.lidar[0].unsure.push_back(board);
    ASSERT_TRUE(look_.Keep(unsure, sweeps_, images_));
  }

  Rig rig_ = test::TestRig();
  FrameBuffer sweeps_{1U << 28U};
  FrameBuffer images_{1U << 28U};
  std::vector<Eigen::Isometry3d> truth_;
  std::vector<std::string> misses_;
  SecondLook look_{rig_};
};

TEST_F(SecondLookTest, FindsTheBoardWhereTheCamerasIs) {
  // Of two stops the lidar had no idea: the other four tell where to look.
  for (int stop = 0; stop < 6; ++stop) ShowStop(stop, stop < 4);
  const auto found = look_.FindBoards({}, /*is_newest_spared=*/false, &misses_);
  ASSERT_THAT(found, SizeIs(6));
  EXPECT_THAT(misses_, IsEmpty());
  EXPECT_TRUE(look_.empty());
  for (std::size_t i = 0; i < 6; ++i) {
    const BoardPose& pose = found[i].stop.lidar[0].board->pose;
    EXPECT_LT((pose.centre_m - truth_[i].translation()).norm(), 0.02) << i;
  }
}

TEST_F(SecondLookTest, SparesTheNewestStopWhereTheBoardMayStillBe) {
  for (int stop = 0; stop < 6; ++stop) ShowStop(stop, true);
  EXPECT_THAT(look_.FindBoards({}, /*is_newest_spared=*/true, &misses_), SizeIs(5));
  EXPECT_EQ(look_.size(), 1u);
}

TEST_F(SecondLookTest, LooksNowhereWithoutAnExtrinsic) {
  for (int stop = 0; stop < 6; ++stop) ShowStop(stop, false);
  EXPECT_THAT(look_.FindBoards({}, /*is_newest_spared=*/false, &misses_), IsEmpty());
  EXPECT_EQ(look_.size(), 6u);
  EXPECT_THAT(misses_, SizeIs(6));
}

TEST_F(SecondLookTest, TakesTheRigFilesGuess) {
  rig_.T_camera_lidar_guess = PerturbLeft(
      CameraFromLidar(), (Vector6d() << 0.03, -0.02, 0.03, 0.05, -0.04, 0.05).finished());
  look_ = SecondLook(rig_);
  for (int stop = 0; stop < 2; ++stop) ShowStop(stop, false);
  EXPECT_THAT(look_.FindBoards({}, /*is_newest_spared=*/false, &misses_), SizeIs(2));
}

}  // namespace
}  // namespace voqcal
