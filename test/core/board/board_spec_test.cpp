#include "core/board/board_spec.hpp"

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

const BoardSpec kBoard{0.61, 0.85, 0.095, 5, 7, 0.002, 0};

TEST(OutlineBoardM, IsCounterClockwiseWithTheWidthFirst) {
  const auto corners = kBoard.OutlineBoardM();
  const auto lengths = kBoard.EdgeLengthsM();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d edge = corners[(i + 1) % 4] - corners[i];
    const Eigen::Vector3d next = corners[(i + 2) % 4] - corners[(i + 1) % 4];
    EXPECT_DOUBLE_EQ(edge.norm(), lengths[i]);
    EXPECT_GT(edge.cross(next).z(), 0);
  }
}

TEST(InnerCornersBoardM, RunAlongXFirstAboutThePatternsCentre) {
  const auto corners = kBoard.InnerCornersBoardM();
  ASSERT_EQ(corners.size(), 35u);
  EXPECT_TRUE((corners[1] - corners[0]).isApprox(Eigen::Vector3d(0.095, 0, 0)));
  EXPECT_TRUE((corners[5] - corners[0]).isApprox(Eigen::Vector3d(0, 0.095, 0)));
  EXPECT_TRUE(corners[17].isApprox(Eigen::Vector3d(0.002, 0, 0)));
}

TEST(BoardSpecProblems, NamesEachBrokenRuleWithItsValue) {
  EXPECT_TRUE(kBoard.Problems().empty());
  BoardSpec board = kBoard;
  board.width_m = -1;
  board.num_corners_y = 2;
  EXPECT_THAT(board.Problems(),
              testing::ElementsAre("width_m must be positive, is -1",
                                   "num_corners_y must be at least 3, is 2"));
}

TEST(BoardSpecProblems, AllowsASquarePlate) {
  BoardSpec board = kBoard;
  board.width_m = board.height_m;
  EXPECT_TRUE(board.Problems().empty());
}

TEST(BoardSpecProblems, FindsAPatternLargerThanTheBoard) {
  BoardSpec board = kBoard;
  board.square_m = 0.16;
  EXPECT_EQ(board.Problems().size(), 2u);
}

}  // namespace
}  // namespace voqcal
