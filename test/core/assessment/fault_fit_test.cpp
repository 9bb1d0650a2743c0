#include "core/assessment/fault_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/rigid.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

test::SyntheticSamplesOptions Noisy() {
  test::SyntheticSamplesOptions options;
  options.lidar_rotation_noise_rad = 0.005;
  options.lidar_centre_noise_m = 0.003;
  return options;
}

TEST(FitFaults, FindsATurnOfAllChessboards) {
  constexpr double kTurnRad = 0.015;  // about the camera's y
  std::vector<BoardSample> samples = test::SynthesizeSamples(Noisy());
  const Eigen::Matrix3d turn = ExpSO3({0.0, kTurnRad, 0.0});
  for (BoardSample& sample : samples) {
    BoardPose& pose = sample.camera.pose;
    pose.normal = turn * pose.normal;
    for (Eigen::Vector3d& corner : pose.corners_m) {
      corner = pose.centre_m + turn * (corner - pose.centre_m);
    }
  }
  const FaultFit fit = FitFaults(
      MakeFaultEquations(
          test::Pointers(samples), test::TestBoard(), test::TestCamera(), test::TestExtrinsic()),
      {kChessboardTurnX, kChessboardTurnY});
  ASSERT_TRUE(fit.is_usable);
  // They truly face as before.
  EXPECT_NEAR(fit.Value(kChessboardTurnX), 0.0, 3 * fit.StandardError(kChessboardTurnX));
  EXPECT_NEAR(fit.Value(kChessboardTurnY), -kTurnRad, 3 * fit.StandardError(kChessboardTurnY));
  EXPECT_LT(fit.StandardError(kChessboardTurnY), 0.1 * kTurnRad);
}

// Each sample left out is foretold worse than it is fitted; by half for each of 6 parameters, and
// as much again for being judged by what it did not help to fit.
TEST(FitFaults, ForetellsSamplesNearlyAsWellAsItFitsThem) {
  const std::vector<BoardSample> samples = test::SynthesizeSamples(Noisy());
  const FaultFit fit = FitFaults(
      MakeFaultEquations(
          test::Pointers(samples), test::TestBoard(), test::TestCamera(), test::TestExtrinsic()),
      {});
  ASSERT_THAT(fit.held_out_log_likelihoods, ::testing::SizeIs(samples.size()));
  double sum = 0;
  for (const double each : fit.held_out_log_likelihoods) sum += each;
  EXPECT_NEAR(fit.log_likelihood - sum, 6.0, 4.0);
}

}  // namespace
}  // namespace voqcal
