#include "core/selection/extrinsic_vote.hpp"

#include <gtest/gtest.h>

#include "core/board/half_turn.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kRotationSigmaRad = 0.01;
constexpr double kCentreSigmaM = 0.01;

Matrix6d Covariance(double rotation_rad, double translation_m) {
  Vector6d squares;
  squares << Eigen::Vector3d::Constant(rotation_rad * rotation_rad),
      Eigen::Vector3d::Constant(translation_m * translation_m);
  return squares.asDiagonal();
}

// Stops of which the lidar is unsure: a door and a wall, the same in all, come before the board.
std::vector<BoardSample> UnsureStops(int num_stops) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_stops;
  scene.lidar_rotation_noise_rad = kRotationSigmaRad;
  scene.lidar_centre_noise_m = kCentreSigmaM;
  scene.num_half_turned = num_stops / 2;
  std::vector<BoardSample> stops = test::SynthesizeSamples(scene);
  LidarBoard door = stops[0].lidar;
  door.pose.centre_m += Eigen::Vector3d(1.0, 0.8, 0.1);
  LidarBoard wall = stops[1].lidar;
  wall.pose.centre_m += Eigen::Vector3d(2.0, -0.5, 0.3);
  for (BoardSample& stop : stops) {
    stop.lidar.pose.covariance = Covariance(kRotationSigmaRad, kCentreSigmaM);
    stop.runners_up = {wall, stop.lidar};
    stop.lidar = door;
    for (LidarBoard* each : {&stop.lidar, &stop.runners_up[0]}) {
      each->pose.covariance = Covariance(kRotationSigmaRad, kCentreSigmaM);
    }
  }
  return stops;
}

// Noise of some ten stops, 10 mrad and 10 mm each: 3 of their deviations over the root of ten are
// 10 mrad; at two metres that is 20 mm.
TEST(VoteForExtrinsic, FindsTheBoardAmongThingsThatDoNotMove) {
  const auto rough = VoteForExtrinsic(UnsureStops(10), 0, test::TestCamera());
  ASSERT_TRUE(rough);
  EXPECT_EQ(rough->num_agreeing, 10);
  EXPECT_THAT(rough->T_camera_lidar, test::IsNear(test::TestExtrinsic(), 0.015, 0.03));
}

TEST(VoteForExtrinsic, FindsNothingWhereNoFourAgree) {
  EXPECT_FALSE(VoteForExtrinsic(UnsureStops(3), 0, test::TestCamera()));
  std::vector<BoardSample> stops = UnsureStops(8);
  for (BoardSample& stop : stops) stop.runners_up.clear();  // doors alone
  EXPECT_FALSE(VoteForExtrinsic(stops, 0, test::TestCamera()));
  EXPECT_FALSE(VoteForExtrinsic({}, 0, test::TestCamera()));
}

TEST(VoteForExtrinsic, ThreeAreEnoughIfTheLidarAloneWasSureOfThem) {
  const std::vector<BoardSample> stops = UnsureStops(3);
  EXPECT_TRUE(VoteForExtrinsic(stops, 3, test::TestCamera()));
  EXPECT_FALSE(VoteForExtrinsic(stops, 2, test::TestCamera()));
}

TEST(VoteForExtrinsic, TakesAGuessWhereFewerStopsAgree) {
  const Eigen::Isometry3d guess = PerturbLeft(
      test::TestExtrinsic(), (Vector6d() << 0.04, -0.03, 0.02, 0.05, 0.05, -0.05).finished());
  const auto rough = VoteForExtrinsic(UnsureStops(3), 0, test::TestCamera(), guess);
  ASSERT_TRUE(rough);
  EXPECT_EQ(rough->num_agreeing, 3);
  EXPECT_THAT(rough->T_camera_lidar, test::IsNear(test::TestExtrinsic(), 0.03, 0.06));
  EXPECT_TRUE(VoteForExtrinsic({}, 0, test::TestCamera(), guess)->T_camera_lidar.isApprox(guess));
}

TEST(VoteForExtrinsic, PlanesAloneMakeNoExtrinsic) {
  std::vector<BoardSample> stops = UnsureStops(8);
  for (BoardSample& stop : stops) {
    stop.lidar = stop.runners_up[1];
    stop.runners_up.clear();
    stop.lidar.sides.fill(SideView::kJoined);
    stop.lidar.pose.covariance = Covariance(1.0, 0.3);
  }
  EXPECT_FALSE(VoteForExtrinsic(stops, 0, test::TestCamera()));
}

TEST(ExpectBoard, IsWhereTheLidarSeesItWithinItsCovariance) {
  const auto stops = UnsureStops(10);
  const auto rough = VoteForExtrinsic(stops, 0, test::TestCamera());
  ASSERT_TRUE(rough);
  for (const BoardSample& stop : stops) {
    const ExpectedBoard expected = ExpectBoard(stop.camera.pose, *rough);
    const Eigen::Vector3d off_m =
        stop.runners_up[1].pose.centre_m - expected.T_lidar_board.translation();
    const Eigen::Matrix3d covariance = expected.covariance.bottomRightCorner<3, 3>();
    EXPECT_LT(off_m.dot(covariance.inverse() * off_m), 14.2);  // 3 sigma of three dimensions
  }
}

}  // namespace
}  // namespace voqcal
