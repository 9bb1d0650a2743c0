#include "core/lidar_detection/lidar_background.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "core/lidar_detection/lidar_board.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

using test::FacingBoard;
using test::SynthesizeLidarBoard;
using test::SyntheticLidarBoardOptions;

/// A room with a poster of exactly the board's size and, from the fourth sweep on, the board.
SyntheticLidarBoardOptions RoomWithPoster() {
  SyntheticLidarBoardOptions scene;
  scene.noise_m = 0.01;
  test::SyntheticBox poster;
  poster.T_lidar_box = FacingBoard({2.3, -1.2, -0.1}, 40.0);
  poster.half_m = {scene.board.width_m / 2, scene.board.height_m / 2, 0.001};
  scene.boxes.push_back(poster);
  scene.T_lidar_board = FacingBoard({2.3, 0.6, -0.1}, 40.0, 10.0);
  return scene;
}

PointCloud Sweep(SyntheticLidarBoardOptions scene, bool has_board, std::uint32_t seed) {
  scene.has_board = has_board;
  scene.seed = seed;
  return SynthesizeLidarBoard(scene);
}

LidarBackground EmptyRoom(const SyntheticLidarBoardOptions& scene,
                          const LidarBackgroundOptions& options) {
  LidarBackground background(options);
  for (std::uint32_t seed = 1; seed <= 3; ++seed) background.Learn(Sweep(scene, false, seed));
  return background;
}

TEST(LidarBackground, KnowsWhatCame) {
  const SyntheticLidarBoardOptions scene = RoomWithPoster();
  const PointCloud with_board = Sweep(scene, true, 9);
  EXPECT_EQ(LidarBackground({}).ShareThatCame(with_board), 0.0);
  const LidarBackground background = EmptyRoom(scene, {});
  EXPECT_EQ(background.ShareThatCame(PointCloud()), 0.0);
  // Of the front half of a sweep, the board's share; without it nothing came.
  EXPECT_GT(background.ShareThatCame(with_board), 0.02);
  EXPECT_LT(background.ShareThatCame(Sweep(scene, false, 9)), 1e-3);
}

TEST(LidarBackground, ForgetsWhatIsNoMoreSeen) {
  const SyntheticLidarBoardOptions scene = RoomWithPoster();
  LidarBackgroundOptions options;
  options.memory_sweeps = 5;
  LidarBackground background = EmptyRoom(scene, options);
  const PointCloud with_board = Sweep(scene, true, 9);
  for (int i = 0; i < options.memory_sweeps; ++i) {
    background.Learn(with_board);
    EXPECT_GT(background.ShareThatCame(with_board), 0.02) << i;
  }
  background.Learn(with_board);
  EXPECT_EQ(background.ShareThatCame(with_board), 0.0);
}

TEST(LidarBackground, NamesBadOptions) {
  LidarBackgroundOptions options;
  options.memory_sweeps = 0;
  options.min_step_m = -1.0;
  EXPECT_EQ(options.Problems(),
            (std::vector<std::string>{"memory_sweeps must be positive, is 0",
                                      "min_step_m must be positive, is -1"}));
  EXPECT_THROW(LidarBackground{options}, std::invalid_argument);
}

TEST(DetectLidarBoard, MovedBoardBeatsAPosterOfItsSize) {
  const SyntheticLidarBoardOptions scene = RoomWithPoster();
  const PointCloud cloud = Sweep(scene, true, 9);
  const auto at_first = DetectLidarBoard(cloud, scene.board, {});
  ASSERT_FALSE(at_first);
  EXPECT_EQ(at_first.error().miss, LidarBoardMiss::kAmbiguous);

  const LidarBackground background = EmptyRoom(scene, {});
  const auto found = DetectLidarBoard(cloud, scene.board, {}, &background);
  ASSERT_TRUE(found) << ToString(found.error());
  ASSERT_EQ(found->size(), 2U);
  EXPECT_LT((found->front().pose.centre_m - scene.T_lidar_board.translation()).norm(), 0.02);
}

TEST(DetectLidarBoard, BackgroundNeitherMovesNorHidesABoard) {
  SyntheticLidarBoardOptions scene = RoomWithPoster();
  scene.boxes.clear();
  const PointCloud cloud = Sweep(scene, true, 9);
  const auto at_first = DetectLidarBoard(cloud, scene.board, {});
  ASSERT_TRUE(at_first);
  LidarBackground background({});
  for (int i = 0; i < 20; ++i) background.Learn(cloud);  // it was there from the beginning
  const auto later = DetectLidarBoard(cloud, scene.board, {}, &background);
  ASSERT_TRUE(later);
  EXPECT_EQ(later->front().pose.centre_m, at_first->front().pose.centre_m);
  EXPECT_EQ(later->front().pose.covariance, at_first->front().pose.covariance);
  EXPECT_EQ(later->front().log_likelihood, at_first->front().log_likelihood);
}

}  // namespace
}  // namespace voqcal
