#include "core/likelihood/camera_faults.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/likelihood/likelihood.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_lens.hpp"
#include "support/synthetic_sweeps.hpp"

namespace voqcal {
namespace {

// As on the real session: some pixels each, at half the image's width.
LensErrors SomeErrors() {
  LensErrors errors;
  errors << 0.006, 0.001, 0.004, -0.005, -0.006, 0.004;
  return errors;
}

std::vector<BoardSample> SamplesThrough(const LensErrors& errors, double noise_px) {
  test::SyntheticSamplesOptions scene;
  scene.lidar_centre_noise_m = 0.002;
  scene.lidar_rotation_noise_rad = 0.003;
  auto samples = test::SamplesWithSweeps(scene, {0.02, 0.015, 0.008, 0.01});
  const CameraModel truth = CorrectedCamera(test::TestCamera(), errors);
  test::SeeThrough(truth, test::TestCamera(), noise_px, &samples);
  return samples;
}

LikelihoodExtrinsic Refine(const std::vector<BoardSample>& samples) {
  return RefineWithLens(test::Pointers(samples),
                        test::TestBoard(),
                        test::TestCamera(),
                        test::TestExtrinsic(),
                        LikelihoodOptions{});
}

TEST(CorrectedCameraPose, IsWhatAFitWithTheCorrectedCameraFinds) {
  auto samples = test::SynthesizeSamples({});
  const LensErrors errors = 0.1 * SomeErrors();
  const CameraModel truth = CorrectedCamera(test::TestCamera(), errors);
  test::SeeThrough(truth, test::TestCamera(), 0.0, &samples);
  for (const BoardSample& sample : samples) {
    const auto fit =
        FitPlanarPose(truth, test::TestBoard().InnerCornersBoardM(), sample.camera.corners_px);
    ASSERT_TRUE(fit);
    const BoardPose corrected =
        CorrectedCameraPose(sample, test::TestBoard(), test::TestCamera(), errors);
    // The errors move boards by up to 2 mrad and 2 mm; what is of second order is a hundredth.
    EXPECT_THAT(TransformFromPose(corrected), test::IsNear(fit->T_camera_board, 1e-4, 1e-4))
        << sample.id;
  }
}

TEST(CameraFaultTerms, SquaresLeftAreThoseOfAFitWithTheCorrectedCamera) {
  constexpr double kCornerErrorPx = 0.5;
  constexpr double kLensError = 0.005;
  const auto samples = SamplesThrough(SomeErrors(), 0.1);
  const LensErrors errors = 0.3 * SomeErrors();
  const CameraModel corrected = CorrectedCamera(test::TestCamera(), errors);
  for (const BoardSample& sample : samples) {
    const CameraFaultTerms terms =
        LensErrorTerms(sample, test::TestBoard(), test::TestCamera(), kLensError, kCornerErrorPx);
    const auto corners_m = test::TestBoard().InnerCornersBoardM();
    const auto squares = [&](const CameraModel& camera) {
      const auto fit = FitPlanarPose(camera, corners_m, sample.camera.corners_px);
      const double n = static_cast<double>(corners_m.size());
      return n * std::pow(fit->reprojection_rms_px / kCornerErrorPx, 2);
    };
    const double expected = errors.dot(terms.information * errors) - 2.0 * terms.pull.dot(errors);
    const double found = squares(corrected) - squares(test::TestCamera());
    EXPECT_NEAR(found, expected, 0.05 * std::abs(expected) + 0.02) << sample.id;
  }
}

TEST(CameraFaultTerms, AreZeroWithoutPixels) {
  const BoardSample sample = test::SynthesizeSamples({}).front();
  const CameraFaultTerms terms =
      LensErrorTerms(sample, test::TestBoard(), test::TestCamera(), 0.005, 0.3);
  EXPECT_EQ(terms.NumFaults(), kNumLensErrors);
  EXPECT_EQ(terms.information.norm(), 0.0);
  EXPECT_EQ(terms.board_by_faults.norm(), 0.0);
}

TEST(RefineWithLens, FindsWhatIsWrongWithTheIntrinsics) {
  const LikelihoodExtrinsic refined = Refine(SamplesThrough(SomeErrors(), 0.2));
  ASSERT_TRUE(refined.IsUsable());
  // The boards stay away from the image's edges, where the two radial errors would differ most: the
  // second is held at zero, and counts with its prior in the others' standard errors.
  const auto& is_observable = refined.lens.is_observable;
  EXPECT_TRUE(std::all_of(
      is_observable.begin(), is_observable.begin() + kRadial4, [](bool is) { return is; }));
  for (Eigen::Index i = 0; i < kNumLensErrors; ++i) {
    EXPECT_LT(std::abs(refined.lens.errors[i] - SomeErrors()[i]),
              3 * refined.lens.standard_errors[i])
        << ToString(static_cast<LensError>(i));
  }
  const Vector6d error = DifferenceLeft(test::TestExtrinsic(), refined.T_camera_lidar);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::abs(error[i]), 3 * std::sqrt(refined.uncertainty.covariance(i, i))) << i;
  }
}

TEST(RefineWithLens, FindsNothingWrongWithTheRightLens) {
  const LikelihoodExtrinsic refined = Refine(SamplesThrough(LensErrors::Zero(), 0.2));
  ASSERT_TRUE(refined.IsUsable());
  for (Eigen::Index i = 0; i < kNumLensErrors; ++i) {
    EXPECT_LT(std::abs(refined.lens.errors[i]), 3 * refined.lens.standard_errors[i]) << i;
  }
}

TEST(RefineWithLens, HoldsAllErrorsWithoutPixels) {
  test::SyntheticSamplesOptions scene;
  scene.lidar_centre_noise_m = 0.002;
  const auto samples = test::SamplesWithSweeps(scene, {0.02, 0.015, 0.008, 0.01});
  const LikelihoodExtrinsic refined = Refine(samples);
  ASSERT_TRUE(refined.IsUsable());
  EXPECT_FALSE(refined.lens.IsObservable());
  EXPECT_EQ(refined.lens.errors.norm(), 0.0);
}

TEST(RefineWithLensNearby, IsTheSameForTheSameSamples) {
  const auto samples = SamplesThrough(SomeErrors(), 0.2);
  const LikelihoodExtrinsic refined = Refine(samples);
  const LikelihoodExtrinsic nearby = RefineWithLensNearby(
      test::Pointers(samples), test::TestBoard(), test::TestCamera(), refined, LikelihoodOptions{});
  ASSERT_TRUE(nearby.IsUsable());
  // Half-turns and noise levels are the same, and so is the minimum, to the step that ends it.
  EXPECT_THAT(nearby.T_camera_lidar, test::IsNear(refined.T_camera_lidar, 2e-5, 2e-5));
  EXPECT_LT((nearby.lens.errors - refined.lens.errors).norm(), 2e-5);
}

}  // namespace
}  // namespace voqcal
