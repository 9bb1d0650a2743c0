#include "core/board/half_turn.hpp"

#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

BoardSpec Board(double width_m, double height_m) {
  BoardSpec board = test::TestBoard();
  board.width_m = width_m;
  board.height_m = height_m;
  return board;
}

// A sample whose lidar corners start so many quarters away from the camera's.
BoardSample TurnedSample(const BoardSpec& board, int num_quarters) {
  const Eigen::Isometry3d T_camera_lidar = test::TestExtrinsic();
  const Eigen::Isometry3d T_camera_board =
      Eigen::Translation3d(0.2, -0.1, 2.5) *
      Eigen::AngleAxisd(M_PI, Eigen::Vector3d(1.0, 0.3, 0.1).normalized());
  BoardSample sample;
  sample.camera.pose = PoseFromTransform(T_camera_board, board);
  const BoardPose lidar = PoseFromTransform(T_camera_lidar.inverse() * T_camera_board, board);
  sample.lidar.pose = TurnedByQuarters(lidar, num_quarters);
  return sample;
}

TEST(LidarPoseInCameraOrder, UndoesHalfTurns) {
  const BoardSample sample = TurnedSample(Board(0.6, 0.8), 2);
  const BoardPose lidar = LidarPoseInCameraOrder(sample, test::TestExtrinsic());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE((test::TestExtrinsic() * lidar.corners_m[i])
                    .isApprox(sample.camera.pose.corners_m[i], 1e-9));
  }
}

TEST(LidarPoseInCameraOrder, UndoesQuarterTurnsOfSquarePlates) {
  for (int quarters = 0; quarters < 4; ++quarters) {
    const BoardSample sample = TurnedSample(Board(0.28, 0.28), quarters);
    const BoardPose lidar = LidarPoseInCameraOrder(sample, test::TestExtrinsic());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_TRUE((test::TestExtrinsic() * lidar.corners_m[i])
                      .isApprox(sample.camera.pose.corners_m[i], 1e-9))
          << quarters;
    }
  }
}

TEST(BestTurn, TriesNoQuartersOfAnOblongPlate) {
  const BoardPose pose = TurnedSample(Board(0.6, 0.8), 0).lidar.pose;
  int num_tried = 0;
  BestTurn(pose, [&num_tried](const BoardPose& /*turned*/) {
    ++num_tried;
    return 0.0;
  });
  EXPECT_EQ(num_tried, 2);
}

}  // namespace
}  // namespace voqcal
