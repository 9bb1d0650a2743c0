#include "core/guidance/extrinsic_information.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "core/guidance/expected_sample.hpp"
#include "core/guidance/placement.hpp"
#include "support/synthetic_sweeps.hpp"

namespace voqcal {
namespace {

std::vector<BoardSample> Samples(int num_samples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  test::LidarFaults faults;
  faults.common_m = 0.02;
  faults.ring_sigma_m = 0.008;
  faults.noise_m = 0.01;
  std::vector<BoardSample> samples = test::SamplesWithSweeps(scene, faults);
  test::Random random(2);
  const test::BoardNoise camera_noise{0.002, 0.0005, 0.002};
  for (BoardSample& sample : samples) {
    sample.lidar.pose.covariance =
        test::CovarianceOf({0.005, 0.003, 0.003}, sample.lidar.pose.centre_m);
    test::AddCameraNoise(camera_noise, &random, &sample);
  }
  return samples;
}

BoardSample FurtherSample() {
  const Placement placement{{1300, 600}, 3.0, 0.4, -0.3};
  const auto pose = PoseOf(placement, test::TestCamera(), test::TestExtrinsic().linear().col(2));
  return ExpectedSample(*pose, test::TestExtrinsic(), test::TestBoard(), test::TestCamera(), {});
}

ExtrinsicInformation InformationOf(const std::vector<BoardSample>& samples) {
  return ExtrinsicInformation(
      test::Pointers(samples), {test::TestExtrinsic(), {}, {}}, LikelihoodOptions{}, 16);
}

double LargestEigenvalue(const Matrix6d& difference) {
  return Eigen::SelfAdjointEigenSolver<Matrix6d>(difference).eigenvalues().maxCoeff();
}

// The oracle: the refinement's own covariance, at its own result.
TEST(ExtrinsicInformation, IsTheLikelihoods) {
  const std::vector<BoardSample> samples = Samples(12);
  const auto pointers = test::Pointers(samples);
  const LikelihoodExtrinsic refined = RefineByLikelihood(pointers, test::TestExtrinsic(), {});
  ASSERT_TRUE(refined.IsUsable());
  const ExtrinsicInformation information(
      pointers, {refined.T_camera_lidar, refined.bias, refined.noise}, {}, 16);
  const Vector6d sigma = information.Covariance().diagonal().cwiseSqrt();
  // It lets all faults be free, and has the boards where the chessboards are: a few percent.
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(sigma[i] / refined.uncertainty.by_likelihood[i], 1, 0.1);
}

TEST(ExtrinsicInformation, OfNothingIsThePrior) {
  const Matrix6d covariance = InformationOf({}).Covariance();
  EXPECT_LT((covariance - 0.25 * Matrix6d::Identity()).norm(), 1e-12);
}

TEST(ExtrinsicInformation, GrowsWithEachSample) {
  const BoardSample further = FurtherSample();
  Matrix6d before = InformationOf({}).Covariance();
  for (int num_samples = 1; num_samples <= 5; ++num_samples) {
    const ExtrinsicInformation information = InformationOf(Samples(num_samples));
    const Matrix6d now = information.Covariance();
    EXPECT_LT(LargestEigenvalue(now - before), 1e-12);
    EXPECT_LT(LargestEigenvalue(information.CovarianceWith(further) - now), 1e-12);
    before = now;
  }
}

}  // namespace
}  // namespace voqcal
