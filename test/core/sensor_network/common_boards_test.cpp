#include "core/sensor_network/common_boards.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>

#include "support/matchers.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kRotationSigmaRad = 0.002;
constexpr double kCentreSigmaM = 0.002;

// Both err as their covariances say.
std::vector<CommonBoard> Boards(int num_boards, std::uint32_t seed) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_boards;
  scene.lidar_rotation_noise_rad = kRotationSigmaRad;
  scene.lidar_centre_noise_m = kCentreSigmaM;
  scene.num_half_turned = num_boards / 3;
  scene.seed = seed;
  std::vector<CommonBoard> boards;
  for (const BoardSample& sample : test::SynthesizeSamples(scene)) {
    Vector6d variances;
    variances << Eigen::Vector3d::Constant(kRotationSigmaRad * kRotationSigmaRad),
        Eigen::Vector3d::Constant(kCentreSigmaM * kCentreSigmaM);
    boards.push_back({sample.lidar.pose, sample.camera.pose});
    boards.back().from.covariance = variances.asDiagonal();
  }
  return boards;
}

TEST(PairOfCameras, RecoversTheTruthWithinItsCovariance) {
  double sum_squares = 0.0;
  constexpr int kDraws = 30;
  for (std::uint32_t seed = 1; seed <= kDraws; ++seed) {
    const auto pair = PairOfCameras("left", "right", Boards(20, seed), test::TestCamera());
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->from, "left");
    EXPECT_EQ(pair->to, "right");
    const Vector6d error = DifferenceLeft(test::TestExtrinsic(), pair->T_to_from);
    sum_squares += error.dot(pair->covariance.llt().solve(error)) / 6.0;
    // Centres at 2 mm of 20 boards, turned by 2 mrad over a few metres' lever.
    EXPECT_THAT(pair->T_to_from, test::IsNear(test::TestExtrinsic(), 3e-3, 8e-3));
  }
  // 180 squares of unit mean: +- 0.105, of which three. That the priors widen by what cameras may
  // err, and these do not, must not show beyond that.
  EXPECT_LT(sum_squares / kDraws, 1.3);
  EXPECT_GT(sum_squares / kDraws, 0.69);
}

// Cameras half a metre apart; both err alike, but only `to` has a lens in the fit.
TEST(PairOfCameras, IsNearlyTheSameTheOtherWayRound) {
  test::SyntheticSamplesOptions scene;
  scene.T_camera_lidar.linear() = ExpSO3({0.03, -0.1, 0.02});
  scene.T_camera_lidar.translation() = Eigen::Vector3d(-0.5, 0.02, 0.01);
  scene.num_samples = 20;
  scene.lidar_rotation_noise_rad = kRotationSigmaRad;
  scene.lidar_centre_noise_m = kCentreSigmaM;
  std::vector<CommonBoard> boards;
  std::vector<CommonBoard> swapped;
  for (const BoardSample& sample : test::SynthesizeSamples(scene)) {
    boards.push_back({sample.lidar.pose, sample.camera.pose});
    swapped.push_back({sample.camera.pose, sample.lidar.pose});
  }
  const auto pair = PairOfCameras("left", "right", boards, test::TestCamera());
  const auto other = PairOfCameras("right", "left", swapped, test::TestCamera());
  ASSERT_TRUE(pair && other);
  const SensorPair back = Reversed(*other);
  EXPECT_EQ(back.from, "left");
  const Vector6d difference = DifferenceLeft(pair->T_to_from, back.T_to_from);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::abs(difference[i]), std::sqrt(pair->covariance(i, i))) << i;
  }
}

TEST(AddCommonBoards, TakesWhatBothSawAtOneTimeOnce) {
  const auto seen = [](std::int64_t utime, double x_m) {
    SeenBoard board;
    board.camera_utime = utime;
    board.pose.centre_m = {x_m, 0.0, 3.0};
    board.pose.normal = -Eigen::Vector3d::UnitZ();
    return board;
  };
  const CommonBoardLimits limits{0.05, 0.1, 0.1};
  std::vector<CommonBoard> boards;
  AddCommonBoards({seen(0, 0.0), seen(1000000, 1.0), seen(2000000, 1.01)},
                  {seen(40000, 5.0), seen(1100000, 6.0), seen(2000000, 7.0)},
                  limits,
                  &boards);
  ASSERT_EQ(boards.size(), 2U);  // the second is 0.1 s apart
  EXPECT_EQ(boards[0].to.centre_m.x(), 5.0);
  EXPECT_EQ(boards[1].from.centre_m.x(), 1.01);
  // Another pair of sessions saw the first pose again.
  AddCommonBoards({seen(9000000, 0.05)}, {seen(9000000, 5.0)}, limits, &boards);
  EXPECT_EQ(boards.size(), 2U);
}

TEST(PairOfCameras, NeedsThreeBoards) {
  EXPECT_FALSE(PairOfCameras("left", "right", Boards(2, 1), test::TestCamera()));
}

}  // namespace
}  // namespace voqcal
