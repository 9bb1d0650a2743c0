#include "core/likelihood/rig_errors.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/likelihood/likelihood.hpp"
#include "support/synthetic_lens.hpp"
#include "support/synthetic_sweeps.hpp"

namespace voqcal {
namespace {

// Seen through a lens that has `errors` against the one that is given.
std::vector<BoardSample> SamplesThrough(const LensErrors& errors) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 20;
  scene.lidar_centre_noise_m = 0.002;
  scene.lidar_rotation_noise_rad = 0.003;
  auto samples = test::SamplesWithSweeps(scene, {0.02, 0.015, 0.008, 0.01});
  test::SeeThrough(CorrectedCamera(test::TestCamera(), errors), test::TestCamera(), 0.2, &samples);
  return samples;
}

struct Refined {
  LikelihoodExtrinsic likelihood;
  Matrix6d by_rig_errors;

  Vector6d Error() const {
    return DifferenceLeft(test::TestExtrinsic(), likelihood.T_camera_lidar);
  }
  /// How many standard errors the worst parameter is off by, without and with the rig's errors.
  double WorstGivenRig() const { return Worst(likelihood.uncertainty.covariance); }
  double Worst() const { return Worst(likelihood.uncertainty.covariance + by_rig_errors); }

 private:
  double Worst(const Matrix6d& covariance) const {
    return Error().cwiseAbs().cwiseQuotient(covariance.diagonal().cwiseSqrt()).maxCoeff();
  }
};

Refined Refine(const std::vector<BoardSample>& samples,
               const BoardSpec& board,
               const LikelihoodOptions& options = {}) {
  const auto all = test::Pointers(samples);
  Refined refined;
  refined.likelihood = RefineByLikelihood(all, test::TestExtrinsic(), options);
  refined.by_rig_errors =
      CovarianceByRigErrors(all, board, test::TestCamera(), refined.likelihood, options);
  return refined;
}

TEST(CovarianceByRigErrors, HoldsThePrincipalPointThatSamplesDoNotTell) {
  LensErrors errors = LensErrors::Zero();
  errors[kPrincipalPointX] = 2 * LikelihoodOptions().lens_error;  // 2 sigma
  const Refined refined = Refine(SamplesThrough(errors), test::TestBoard());
  ASSERT_TRUE(refined.likelihood.IsUsable());
  EXPECT_GT(refined.WorstGivenRig(), 3.0);
  EXPECT_LT(refined.Worst(), 2.5);
}

TEST(CovarianceByRigErrors, IsAsMuchWiderAsTheSamplesContradictTheLens) {
  LensErrors errors;
  errors << 0.02, 0.0, 0.0, 0.0, 0.0, 0.0;
  LikelihoodOptions options;
  options.lens_error = 0.001;  // which the samples' lens exceeds by 20 sigma
  const Refined refined = Refine(SamplesThrough(errors), test::TestBoard(), options);
  ASSERT_TRUE(refined.likelihood.IsUsable());
  EXPECT_GT(refined.WorstGivenRig(), 5.0);
  EXPECT_LT(refined.Worst(), 2.5);
}

TEST(CovarianceByRigErrors, IsAboutWhatIsPlausibleWhereNothingIsWrong) {
  const Refined refined = Refine(SamplesThrough(LensErrors::Zero()), test::TestBoard());
  ASSERT_TRUE(refined.likelihood.IsUsable());
  const double turn_rad =
      LikelihoodOptions{}.lens_error * LensReachPx(test::TestCamera()) / test::TestCamera().fx_px;
  const Vector6d sigma = refined.by_rig_errors.diagonal().cwiseSqrt();
  EXPECT_LT(sigma.head<3>().maxCoeff(), 1.5 * turn_rad);
  EXPECT_GT(sigma[1], 0.2 * turn_rad);  // cx, about y
}

TEST(CovarianceByRigErrors, IsNoSmallerWhereNoCornersTell) {
  const auto with_corners = SamplesThrough(LensErrors::Zero());
  auto samples = with_corners;
  for (BoardSample& sample : samples) sample.camera.corners_px.clear();
  const Vector6d with = Refine(with_corners, test::TestBoard()).by_rig_errors.diagonal();
  const Vector6d without = Refine(samples, test::TestBoard()).by_rig_errors.diagonal();
  EXPECT_GT(without.cwiseQuotient(with).minCoeff(), 0.9);
}

// The squares' error is the only one: the board is as much farther away.
TEST(CovarianceByRigErrors, MovesAsARefinementWithOtherSquaresDoes) {
  LikelihoodOptions options;
  options.lens_error = 1e-9;
  options.pattern_offset_error_m = 0;
  options.board_size_error = 0.0002;  // too little for samples to tell
  const auto samples = SamplesThrough(LensErrors::Zero());
  auto larger = samples;
  for (BoardSample& sample : larger) {
    Eigen::Isometry3d T_camera_board = TransformFromPose(sample.camera.pose);
    T_camera_board.translation() *= 1.0 + options.board_size_error;
    const Matrix6d covariance = sample.camera.pose.covariance;
    sample.camera.pose = PoseFromTransform(T_camera_board, test::TestBoard());
    sample.camera.pose.covariance = covariance;
  }
  const auto all = test::Pointers(samples);
  const LikelihoodExtrinsic refined = RefineByLikelihood(all, test::TestExtrinsic(), options);
  const LikelihoodExtrinsic moved =
      RefineByLikelihood(test::Pointers(larger), test::TestExtrinsic(), options);
  const Matrix6d covariance =
      CovarianceByRigErrors(all, test::TestBoard(), test::TestCamera(), refined, options);
  const double along_view_m =
      DifferenceLeft(refined.T_camera_lidar, moved.T_camera_lidar).tail<3>().norm();
  const double sigma_m = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
  EXPECT_GT(along_view_m, 0.7 * sigma_m);
  EXPECT_LT(along_view_m, 1.4 * sigma_m);
}

TEST(CovarianceByRigErrors, IsNearlyNothingOfARigFileThatIsExact) {
  LikelihoodOptions exact;
  exact.lens_error = 1e-9;
  exact.board_size_error = exact.pattern_offset_error_m = 0;
  const auto samples = SamplesThrough(LensErrors::Zero());
  const auto all = test::Pointers(samples);
  const Matrix6d covariance =
      CovarianceByRigErrors(all,
                            test::TestBoard(),
                            test::TestCamera(),
                            RefineByLikelihood(all, test::TestExtrinsic(), exact),
                            exact);
  EXPECT_LT(std::sqrt(covariance.diagonal().maxCoeff()), 1e-5);
}

}  // namespace
}  // namespace voqcal
