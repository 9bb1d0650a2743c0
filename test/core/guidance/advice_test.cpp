#include "core/guidance/advice.hpp"

#include <gtest/gtest.h>

#include "core/guidance/placement.hpp"
#include "core/units.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

const Eigen::Vector3d kUp(0, -1, 0);

Eigen::Isometry3d Pose(
    double x_px, double y_px, double distance_m, double yaw_deg = 0.0, double pitch_deg = 0.0) {
  Placement placement;
  placement.centre_px = {x_px, y_px};
  placement.distance_m = distance_m;
  placement.yaw_rad = yaw_deg * kRadPerDeg;
  placement.pitch_rad = pitch_deg * kRadPerDeg;
  return *PoseOf(placement, test::TestCamera(), kUp);
}

std::string FromNothing(const Eigen::Isometry3d& T_camera_board) {
  return HoldWords(T_camera_board, {}, test::TestCamera());
}

std::string FromLast(const Eigen::Vector3d& last_m, const Eigen::Vector3d& next_m) {
  Eigen::Isometry3d T_camera_board = Pose(960, 604, 2.0);
  T_camera_board.linear().col(2) = -next_m.normalized();
  T_camera_board.translation() = next_m;
  return HoldWords(T_camera_board, last_m, test::TestCamera());
}

TEST(HoldWords, OfTheFirstPoseStartFromTheCamera) {
  EXPECT_EQ(FromNothing(Pose(960, 604, 2.04)),
            "Hold the board 2 m from the camera, in the middle of the image. Hold it as a diamond, "
            "facing the camera.");
  EXPECT_EQ(FromNothing(Pose(300, 200, 1.23, 0, 33)),
            "Hold the board 1.2 m from the camera, in the upper left part of the image. Hold it as "
            "a diamond, the top 30 degrees towards the camera.");
  EXPECT_EQ(FromNothing(Pose(1700, 604, 3.3, -18, -41)),
            "Hold the board 3.5 m from the camera, in the right part of the image. Hold it as a "
            "diamond, the bottom 40 degrees and the right side 20 degrees towards the camera.");
}

TEST(HoldWords, OfFurtherPosesSayWhereToMove) {
  EXPECT_EQ(FromLast({0, 0, 2}, {-0.52, 0, 3.97}),
            "Move the board 2 m away from the camera and half a metre to the left. Hold it as a "
            "diamond, facing the camera.");
  EXPECT_EQ(FromLast({0, 0, 3}, {0.33, -0.24, 1.9}),
            "Move the board 1.1 m towards the camera, 30 cm to the right and 20 cm up. Hold it as "
            "a diamond, facing the camera.");
}

TEST(HoldWords, LeaveOutWhatNobodyCanDo) {
  EXPECT_EQ(FromLast({0, 0, 2}, {0.1, -0.1, 2.1}),
            "Leave the board where it is. Hold it as a diamond, facing the camera.");
  EXPECT_EQ(FromNothing(Pose(960, 604, 2.0, 4, -4)),
            "Hold the board 2 m from the camera, in the middle of the image. Hold it as a diamond, "
            "facing the camera.");
}

// A lidar that is rolled against the camera: a diamond to its rows is none in the image.
TEST(HoldWords, GoByTheImageHoweverTheLidarIsTurned) {
  const auto words = [](double roll_deg) {
    const double roll_rad = roll_deg * kRadPerDeg;
    const Eigen::Vector3d up(std::sin(roll_rad), -std::cos(roll_rad), 0);
    const Eigen::Isometry3d T_camera_board =
        *PoseOf({{960, 604}, 2.0, 0.0, 30 * kRadPerDeg}, test::TestCamera(), up);
    const Eigen::Vector3d move_m(0.6, 0, 0);
    return HoldWords(T_camera_board, T_camera_board.translation() - move_m, test::TestCamera());
  };
  EXPECT_EQ(words(0),
            "Move the board 60 cm to the right. Hold it as a diamond, the top 30 degrees towards "
            "the camera.");
  EXPECT_EQ(words(45),
            "Move the board 60 cm to the right. Hold it upright, the top 20 degrees and the right "
            "side 20 degrees towards the camera.");
  EXPECT_EQ(words(90),
            "Move the board 60 cm to the right. Hold it as a diamond, the right side 30 degrees "
            "towards the camera.");
}

}  // namespace
}  // namespace voqcal
