#include "core/likelihood/likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/likelihood/likelihood_terms.hpp"
#include "support/matchers.hpp"
#include "support/sanitizers.hpp"
#include "support/synthetic_samples.hpp"
#include "support/synthetic_sweeps.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Eigen::Isometry3d RoughStart() {
  Vector6d delta;
  delta << 0.02, -0.03, 0.02, 0.03, -0.04, 0.05;
  return PerturbLeft(test::TestExtrinsic(), delta);
}

LikelihoodExtrinsic Refine(const std::vector<BoardSample>& samples) {
  return RefineByLikelihood(test::Pointers(samples), RoughStart(), {});
}

// Faults as a VLP-16 has them, and outlines that are seen with errors.
LikelihoodExtrinsic RefineFaulty(std::uint32_t seed) {
  test::SyntheticSamplesOptions scene;
  scene.seed = seed;
  scene.lidar_centre_noise_m = 0.002;
  scene.lidar_rotation_noise_rad = 0.003;
  return Refine(test::SamplesWithSweeps(scene, {0.02, 0.015, 0.008, 0.01}));
}

BoardAndLidar Perturbed(const BoardAndLidar& at, int parameter, double step) {
  const Vector6d delta = step * Vector6d::Unit(parameter % 6);
  if (parameter < 6) return {PerturbLeft(at.T_camera_lidar, delta), at.T_camera_board};
  return {at.T_camera_lidar, PerturbLeft(at.T_camera_board, delta)};
}

TEST(RefineByLikelihood, LeavesTheRaysWhereAllChessboardsAreTurned) {
  constexpr double kTurnRad = 0.01;
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 20;
  scene.lidar_centre_noise_m = 0.002;
  scene.lidar_rotation_noise_rad = 0.003;
  auto samples = test::SamplesWithSweeps(scene, {0.02, 0.015, 0.008, 0.01});
  for (BoardSample& sample : samples) {
    Vector6d turn = Vector6d::Zero();
    turn[0] = kTurnRad;
    sample.camera.pose = PoseFromTransform(PerturbLeft(TransformFromPose(sample.camera.pose), turn),
                                           test::TestBoard());
  }
  const LikelihoodExtrinsic refined = Refine(samples);
  ASSERT_TRUE(refined.IsUsable());
  EXPECT_LT(RotationAngleBetween(refined.T_camera_lidar.linear(), test::TestExtrinsic().linear()),
            0.2 * kTurnRad);
  ASSERT_EQ(refined.camera_faults.values.size(), 2);
  EXPECT_NEAR(refined.camera_faults.values[0], kTurnRad, 0.2 * kTurnRad);
}

TEST(LikelihoodTerms, JacobiansAgreeWithDifferences) {
  // Central differences of functions of curvature about 10: 1e-11 off by the step, 1e-10 by
  // rounding.
  constexpr double kStep = 1e-6;
  constexpr double kTolerance = 1e-8;
  const BoardSample sample = test::SynthesizeSamples({}).front();
  const BoardAndLidar at{RoughStart(), TransformFromPose(sample.camera.pose)};
  const OutlineRays outline = OutlineRaysOf(sample.lidar.pose);
  const Eigen::Vector3d direction = Eigen::Vector3d(2.0, 0.3, -0.2).normalized();
  Vector12d J_range;
  Matrix312d J_outline, J_plane;
  RangeToBoardM(at, direction, &J_range);
  const Eigen::Vector3d plane = PlaneInLidar(at, &J_plane);
  EXPECT_NEAR(1.0 / plane.dot(direction), RangeToBoardM(at, direction, nullptr), 1e-12);
  OutlineResidual(at, outline, 0.0, &J_outline);
  for (int i = 0; i < 12; ++i) {
    const BoardAndLidar plus = Perturbed(at, i, kStep);
    const BoardAndLidar minus = Perturbed(at, i, -kStep);
    const double range_slope =
        (RangeToBoardM(plus, direction, nullptr) - RangeToBoardM(minus, direction, nullptr)) /
        (2 * kStep);
    EXPECT_NEAR(J_range[i], range_slope, kTolerance) << i;
    const Eigen::Vector3d plane_slope =
        (PlaneInLidar(plus, nullptr) - PlaneInLidar(minus, nullptr)) / (2 * kStep);
    EXPECT_LT((J_plane.col(i) - plane_slope).norm(), kTolerance) << i;
    const Eigen::Vector3d outline_slope = (OutlineResidual(plus, outline, 0.0, nullptr) -
                                           OutlineResidual(minus, outline, 0.0, nullptr)) /
                                          (2 * kStep);
    EXPECT_LT((J_outline.col(i) - outline_slope).norm(), kTolerance) << i;
  }
}

TEST(LikelihoodTerms, OutlineResidualDoesNotSeeErrorsOfRange) {
  const BoardSample sample = test::SynthesizeSamples({}).front();
  const BoardAndLidar at{test::TestExtrinsic(), TransformFromPose(sample.camera.pose)};
  BoardPose farther = sample.lidar.pose;
  farther.centre_m *= 1.02;
  EXPECT_LT(OutlineResidual(at, OutlineRaysOf(farther), 0.0, nullptr).norm(), 1e-12);
}

TEST(LikelihoodTerms, OutlineResidualSeesALiftedOutline) {
  const BoardSample sample = test::SynthesizeSamples({}).front();
  const BoardAndLidar at{test::TestExtrinsic(), TransformFromPose(sample.camera.pose)};
  BoardPose lifted = sample.lidar.pose;
  lifted.centre_m.z() += 0.002;
  const OutlineRays outline = OutlineRaysOf(lifted);
  // The part of the lift along the ray, which residuals do not see, is second order in it.
  EXPECT_LT((OutlineResidual(at, outline, 0.0, nullptr) + 0.002 * OutlineByLift(outline)).norm(),
            1e-5);
  EXPECT_LT(OutlineResidual(at, outline, 0.002, nullptr).norm(), 1e-5);
}

// Boards that the extrinsic puts 10 mm farther agree with the chessboards if ranges are as much too
// long; the boards stand within 30 degrees of the camera's z.
TEST(RefineByLikelihood, BiasFollowsAGivenExtrinsic) {
  const LikelihoodExtrinsic refined = RefineFaulty(1);
  ASSERT_TRUE(refined.IsUsable());
  const double common_m = refined.bias.common.value_m;
  EXPECT_EQ(refined.BiasAt(refined.T_camera_lidar).common.value_m, common_m);
  const Eigen::Isometry3d farther = PerturbLeft(refined.T_camera_lidar, 0.01 * Vector6d::Unit(5));
  EXPECT_NEAR(refined.BiasAt(farther).common.value_m - common_m, 0.01, 0.002);
}

TEST(RefineByLikelihood, FindsHowMuchHigherOutlinesLook) {
  test::LidarFaults faults;
  faults.noise_m = 0.002;  // planes must hold the extrinsic to tell
  faults.lift_m = 0.002;
  const LikelihoodExtrinsic refined = Refine(test::SamplesWithSweeps({}, faults));
  ASSERT_TRUE(refined.IsUsable());
  // Planes hold the extrinsic against it; two priors of it, which share it between lift and rise.
  const double at_2_m = refined.bias.outline_lift.value_m + 2.0 * refined.bias.outline_rise.value_m;
  EXPECT_NEAR(at_2_m, 0.002, 0.001);
  const Vector6d error = DifferenceLeft(test::TestExtrinsic(), refined.T_camera_lidar);
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::abs(error[i]), 3.0 * std::sqrt(refined.uncertainty.covariance(i, i))) << i;
  }
}

TEST(RefineByLikelihood, IsTheTruthOnCleanData) {
  const LikelihoodExtrinsic refined = Refine(test::SamplesWithSweeps({}, {}));
  EXPECT_EQ(refined.status, RefineStatus::kConverged);
  // Points are stored as float: 1e-7 of 3 m, averaged over thousands.
  EXPECT_THAT(refined.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 1e-7, 1e-6));
  EXPECT_NEAR(refined.bias.common.value_m, 0.0, 1e-6);
}

TEST(RefineByLikelihood, FindsEachFaultWithinThreeStandardErrors) {
  const LikelihoodExtrinsic refined = RefineFaulty(1);
  ASSERT_TRUE(refined.IsUsable());
  const auto expect_found = [](const BiasEstimate& estimate, double truth_m, const char* what) {
    EXPECT_TRUE(estimate.is_observable) << what;
    EXPECT_LT(std::abs(estimate.value_m - truth_m), 3 * estimate.standard_error_m) << what;
  };
  expect_found(refined.bias.common, 0.02, "common");
  expect_found(refined.bias.dark_step, 0.015, "dark step");
  const auto ring_offsets_m = test::RingOffsetsM({0, 0, 0.008, 0});
  for (std::size_t i = 0; i < refined.bias.rings.size(); ++i) {
    if (refined.bias.rings[i].is_observable) {
      expect_found(refined.bias.rings[i], ring_offsets_m[i], "ring");
    }
  }
  // 8,000 returns know the noise to 1 %; Cauchy's weights and the fit leave 3 %.
  EXPECT_NEAR(refined.noise.range_m, 0.01, 0.0003);
}

TEST(RefineByLikelihood, FindsTheExtrinsicWithinItsCovariance) {
  VOQCAL_LEAVE_TO_RELEASE();
  // Mean of 6 degrees of freedom over 10 trials: 6 +- 1.1. Claims that are too careful are allowed
  // (model errors are expected that this data do not have), twice the variance too bold is not.
  double sum = 0.0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const LikelihoodExtrinsic refined = RefineFaulty(seed);
    ASSERT_TRUE(refined.IsUsable());
    const Vector6d error = DifferenceLeft(test::TestExtrinsic(), refined.T_camera_lidar);
    sum += error.dot(refined.uncertainty.covariance.inverse() * error);
  }
  EXPECT_LT(sum / 10, 12.0);
}

TEST(RefineByLikelihood, SaysWhenTheCommonOffsetIsUnobservable) {
  test::SyntheticSamplesOptions scene;
  scene.max_tilt_rad = 0.0;  // all boards frontal...
  scene.spread = 0.0;        // ...at one place: an offset is the same as a step back
  const LikelihoodExtrinsic refined =
      Refine(test::SamplesWithSweeps(scene, {0.02, 0.015, 0.0, 0.01}));
  EXPECT_FALSE(refined.bias.common.is_observable);
  EXPECT_EQ(refined.bias.common.value_m, 0.0);
  EXPECT_EQ(refined.bias.common.Text(), "unobservable");
  ASSERT_TRUE(refined.IsUsable());
  // Its prior, not narrowed to a half, is in the depth (camera z) that it cannot be told from.
  EXPECT_GT(std::sqrt(refined.uncertainty.covariance(5, 5)),
            0.5 * LikelihoodOptions{}.common_prior_m);
}

TEST(RefineByLikelihood, LeavesShadesAndRingsAloneThatTheCloudLacks) {
  auto samples = test::SamplesWithSweeps({}, {0.02, 0.0, 0.0, 0.01});
  for (BoardSample& sample : samples) {
    sample.lidar.points_lidar_m.has_intensity = sample.lidar.points_lidar_m.has_ring = false;
  }
  const LikelihoodExtrinsic refined = Refine(samples);
  ASSERT_TRUE(refined.IsUsable());
  EXPECT_FALSE(refined.bias.dark_step.is_observable);
  EXPECT_NEAR(refined.bias.common.value_m, 0.02, 3 * refined.bias.common.standard_error_m);
}

TEST(RefineByLikelihood, IsTheSameForTheSameInput) {
  const LikelihoodExtrinsic first = RefineFaulty(2);
  const LikelihoodExtrinsic second = RefineFaulty(2);
  EXPECT_EQ(first.T_camera_lidar.matrix(), second.T_camera_lidar.matrix());
  EXPECT_EQ(first.uncertainty.covariance, second.uncertainty.covariance);
}

TEST(RefineByLikelihood, NeedsThreeSamples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 2;
  EXPECT_EQ(Refine(test::SamplesWithSweeps(scene, {})).status, RefineStatus::kDegenerate);
}

TEST(LikelihoodExtrinsic, SummarisesInOneLine) {
  const std::string line = RefineFaulty(1).Summary();
  EXPECT_THAT(line, HasSubstr("likelihood converged: 1 sigma up to"));
  EXPECT_THAT(line, HasSubstr("range offset"));
  EXPECT_THAT(line, Not(HasSubstr("\n")));
}

TEST(CorrectedPose, IsTheBoardWhereItIs) {
  auto samples = test::SamplesWithSweeps({}, {0.02, 0.015, 0.008, 0.0});
  LidarBias bias;
  bias.common.value_m = 0.02;
  bias.dark_step.value_m = 0.015;
  for (const double offset_m : test::RingOffsetsM({0, 0, 0.008, 0})) {
    bias.rings.push_back({offset_m, 0.0, true});
  }
  bias.shades = MakeShadeScale(test::Pointers(samples));
  for (BoardSample& sample : samples) {
    const BoardPose truth = sample.lidar.pose;
    const Eigen::Vector3d ray = truth.centre_m.normalized();
    for (Eigen::Vector3d& corner_m : sample.lidar.pose.corners_m) corner_m += 0.02 * ray;
    sample.lidar.pose.centre_m += 0.02 * ray;
    const BoardPose corrected = CorrectedPose(sample.lidar, bias);
    // Floats again, and a plane of a few hundred of them.
    EXPECT_LT((corrected.centre_m - truth.centre_m).norm(), 1e-6);
    EXPECT_LT((corrected.normal - truth.normal).norm(), 1e-5);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LT((corrected.corners_m[k] - truth.corners_m[k]).norm(), 1e-5);
    }
  }
}

TEST(LikelihoodOptions, NamesEachProblem) {
  EXPECT_THAT(LikelihoodOptions{}.Problems(), IsEmpty());
  LikelihoodOptions options;
  options.ring_prior_m = 0.0;
  options.max_iterations = 0;
  EXPECT_THAT(
      options.Problems(),
      ElementsAre("ring_prior_m must be positive, is 0", "max_iterations must be positive, is 0"));
  EXPECT_THROW(RefineByLikelihood({}, RoughStart(), options), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
