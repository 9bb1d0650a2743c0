// What a prior of the board's pose does: it says where to look, and that a part is enough.

#include <cmath>

#include <gtest/gtest.h>

#include "core/lidar_detection/lidar_board.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

using test::FacingBoard;
using test::SynthesizeLidarBoard;
using test::SyntheticBox;
using test::SyntheticLidarBoardOptions;

/// A board in the plane of a wide, high wall's end: no side is measured but the right one.
SyntheticLidarBoardOptions Scene() {
  SyntheticLidarBoardOptions scene;
  scene.noise_m = 0.005;
  scene.num_rings = 64;
  scene.T_lidar_board = FacingBoard({2.3, 0.0, 0.0}, 0.0);
  SyntheticBox leaf;
  leaf.T_lidar_box.translation() = Eigen::Vector3d(2.35, 0.5, 0.0);
  leaf.half_m = {0.049, 0.8, 1.2};  // from y = -0.3 m
  scene.boxes.push_back(leaf);
  return scene;
}

BoardPrior PriorAt(const Eigen::Isometry3d& T_lidar_board) {
  BoardPrior prior;
  prior.T_lidar_board = T_lidar_board;
  prior.covariance.diagonal() << 4e-4, 4e-4, 4e-4, 4e-4, 4e-4, 4e-4;
  return prior;
}

TEST(DetectExpectedBoard, MeasuresWhatIsThereAndNoMore) {
  const SyntheticLidarBoardOptions scene = Scene();
  const PointCloud cloud = SynthesizeLidarBoard(scene);
  EXPECT_FALSE(DetectLidarBoard(cloud, scene.board, {}));
  const auto found =
      DetectLidarBoard(cloud, scene.board, {}, nullptr, PriorAt(scene.T_lidar_board));
  ASSERT_TRUE(found) << ToString(found.error());
  const LidarBoard& board = found->front();
  EXPECT_LE(NumMeasuredSides(board), 1);
  // The plane is known.
  EXPECT_LT(AngleBetween(board.pose.normal, scene.T_lidar_board.linear().col(2)), 0.005);
  const Eigen::Matrix3d R = scene.T_lidar_board.linear();
  const Eigen::Matrix3d in_board =
      R.transpose() * board.pose.covariance.bottomRightCorner<3, 3>() * R;
  EXPECT_TRUE(board.pose.covariance.allFinite());
  EXPECT_LT(std::sqrt(in_board(2, 2)), 0.005);
}

TEST(DetectExpectedBoard, WhatIsElsewhereIsNotIt) {
  SyntheticLidarBoardOptions scene = Scene();
  scene.boxes.clear();
  const PointCloud cloud = SynthesizeLidarBoard(scene);
  Eigen::Isometry3d elsewhere = scene.T_lidar_board;
  elsewhere.translation().y() += 0.3;
  EXPECT_TRUE(DetectLidarBoard(cloud, scene.board, {}, nullptr, PriorAt(scene.T_lidar_board)));
  EXPECT_FALSE(DetectLidarBoard(cloud, scene.board, {}, nullptr, PriorAt(elsewhere)));
}

TEST(DetectExpectedBoard, PriorWithoutACovarianceIsNamed) {
  BoardPrior prior;
  EXPECT_THROW(DetectLidarBoard({}, Scene().board, {}, nullptr, prior), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
