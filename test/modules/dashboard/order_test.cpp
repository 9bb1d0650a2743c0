#include "dashboard/order.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/convert_result.hpp"
#include "modules/nodes/node_test.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

/// Upright, facing the camera, 2 m ahead and so far to the right.
BoardPose BoardAt(double right_m) {
  BoardPose pose;
  pose.centre_m = {right_m, 0, 2};
  pose.corners_m = {Eigen::Vector3d{right_m - 0.5, -0.4, 2},
                    {right_m + 0.5, -0.4, 2},
                    {right_m + 0.5, 0.4, 2},
                    {right_m - 0.5, 0.4, 2}};
  return pose;
}

next_pose_t Asked() {
  next_pose_t next{};
  next.advice = "from the last sample";
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.translation() = Eigen::Vector3d(0, 0, 2);
  next.T_camera_board = ToMessage(T_camera_board);
  const BoardPose pose = BoardAt(0);
  for (std::size_t i = 0; i < 4; ++i) {
    Eigen::Map<Eigen::Vector3d>(next.corners_camera_m[i]) = pose.corners_m[i];
  }
  return next;
}

TEST(Order, IsFromWhereTheBoardIsNow) {
  const Order order = OrderFor(Asked(), BoardAt(0.4), test::TestCamera());
  EXPECT_THAT(order.words, HasSubstr("40 cm to the left"));
  EXPECT_NEAR(order.away_m, 0.4, 1e-9);
}

TEST(Order, IsToHoldStillWhereItIsAsked) {
  BoardPose turned = BoardAt(0.05);  // and by half a turn, which looks the same
  std::swap(turned.corners_m[0], turned.corners_m[2]);
  std::swap(turned.corners_m[1], turned.corners_m[3]);
  const Order order = OrderFor(Asked(), turned, test::TestCamera());
  EXPECT_EQ(order.words, "It is there: hold it still.");
  EXPECT_NEAR(order.away_m, 0.05, 1e-9);
}

TEST(Order, StartsFromTheCameraWhileTheBoardIsNotSeen) {
  const Order order = OrderFor(Asked(), {}, test::TestCamera());
  EXPECT_THAT(order.words, HasSubstr("2 m from the camera, in the middle of the image"));
  EXPECT_TRUE(std::isnan(order.away_m));
}

TEST(Order, IsTheGuidesWhereNothingIsToBeDone) {
  next_pose_t next = Asked();
  next.is_enough = 1;
  EXPECT_EQ(OrderFor(next, BoardAt(0.4), test::TestCamera()).words, "from the last sample");
}

}  // namespace
}  // namespace voqcal
