#include "core/assessment/best_extrinsic.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/selection/consistency.hpp"
#include "core/units.hpp"
#include "support/synthetic_sweeps.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

AveragedExtrinsic RoughAverage() {
  Vector6d delta;
  delta << 0.004, -0.003, 0.004, 0.006, -0.006, 0.008;
  AveragedExtrinsic average;
  average.T_camera_lidar = PerturbLeft(test::TestExtrinsic(), delta);
  average.spread.setConstant(0.004);
  average.num_kept = 50;
  return average;
}

BestExtrinsic Best(const std::vector<const BoardSample*>& samples,
                   const std::optional<RefineMethod>& method = {}) {
  RefinerOptions options;
  options.method = method;
  return RefineBest(samples, test::TestBoard(), test::TestCamera(), RoughAverage(), {}, options);
}

test::SyntheticSamplesOptions NoisyScene(int num_samples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.lidar_centre_noise_m = 0.002;
  scene.lidar_rotation_noise_rad = 0.003;
  return scene;
}

const test::LidarFaults kFaults = {0.02, 0.015, 0.008, 0.01};

TEST(RefineBest, IsJointAndNearlyTheLikelihoodWhereItsModelIsRight) {
  const auto samples = test::SamplesWithSweeps(NoisyScene(20), kFaults);
  const BestExtrinsic best = Best(test::Pointers(samples));
  ASSERT_TRUE(best.IsUsable()) << best.problem;
  EXPECT_EQ(best.method, RefineMethod::kJoint);
  EXPECT_TRUE(best.Bias().common.is_observable);
  EXPECT_EQ(best.scene_note, "no scene was kept with the samples");
  ASSERT_THAT(best.trials, SizeIs(4));
  const MethodTrial& joint = best.trials[3];
  EXPECT_LT(joint.ErrorMm(), best.trials[0].ErrorMm());
  EXPECT_LT(joint.ErrorMm(), best.trials[1].ErrorMm());
  EXPECT_LT(joint.ErrorMm(), 1.1 * best.trials[2].ErrorMm());
}

// As a principal point does that is given wrongly.
TEST(RefineBest, LeavesTheRaysWhereAllChessboardsAreTurned) {
  constexpr double kTurnRad = 0.01;
  auto samples = test::SamplesWithSweeps(NoisyScene(20), kFaults);
  for (BoardSample& sample : samples) {
    Vector6d turn = Vector6d::Zero();
    turn[1] = kTurnRad;
    const Matrix6d covariance = sample.camera.pose.covariance;
    sample.camera.pose = PoseFromTransform(PerturbLeft(TransformFromPose(sample.camera.pose), turn),
                                           test::TestBoard());
    sample.camera.pose.covariance = covariance;
  }
  const BestExtrinsic best = Best(test::Pointers(samples));
  ASSERT_TRUE(best.IsUsable()) << best.problem;
  EXPECT_LT(RotationAngleBetween(best.T_camera_lidar.linear(), test::TestExtrinsic().linear()),
            0.2 * kTurnRad);
  const ChessboardTurn& turn = best.chessboard_turn;
  EXPECT_NEAR(turn.value_rad.y(), kTurnRad, 0.3 * kTurnRad);
  EXPECT_NEAR(turn.value_rad.y(), kTurnRad, 3.0 * turn.standard_error_rad.y());
  EXPECT_LT(turn.standard_error_rad.y(), 0.3 * kTurnRad);
  EXPECT_LT(best.held_out.normal_deg.mean, 0.5 * kDegPerRad * kTurnRad);
}

TEST(RefineBest, IsTheReprojectionsWithoutPointsAndScenes) {
  const auto samples = test::SynthesizeSamples(NoisyScene(20));
  const BestExtrinsic best = Best(test::Pointers(samples));
  EXPECT_EQ(best.method, RefineMethod::kReprojection);
  EXPECT_EQ(best.trials[3].problem, "there is nothing to join: no likelihood, no scenes");
  EXPECT_EQ(best.trials[2].problem, "most samples have no points of the board");
  EXPECT_FALSE(best.Bias().IsObservable());
}

// Three boards cannot show how large errors are: the priors do, and the lidar's common offset.
TEST(RefineBest, IsWideOfThreePoses) {
  const auto samples = test::SamplesWithSweeps(NoisyScene(3), kFaults);
  const BestExtrinsic best = Best(test::Pointers(samples));
  EXPECT_EQ(best.method, RefineMethod::kJoint);
  EXPECT_GT(best.covariance_given_rig(5, 5), 0.01 * 0.01);
  EXPECT_LT(best.covariance_given_rig(5, 5), 0.04 * 0.04);
}

TEST(RefineBest, SaysWhereTheLidarIsLessSurelyThanWhereItsPointsLand) {
  const auto samples = test::SamplesWithSweeps(NoisyScene(20), kFaults);
  for (const RefineMethod method : {RefineMethod::kAverage, RefineMethod::kJoint}) {
    const BestExtrinsic best = Best(test::Pointers(samples), method);
    const Matrix6d by_rig = best.covariance - best.covariance_given_rig;
    EXPECT_GT(by_rig.diagonal().minCoeff(), 0) << ToString(method);
    EXPECT_GT(by_rig(1, 1), std::pow(0.2 * 2.0 / test::TestCamera().fx_px, 2));  // 2 px of cx
  }
}

TEST(RefineBest, DoesNotKnowWhereTheLidarIsWithoutALikelihood) {
  const auto samples = test::SynthesizeSamples(NoisyScene(20));
  const BestExtrinsic best = Best(test::Pointers(samples));
  ASSERT_TRUE(best.IsUsable()) << best.problem;
  EXPECT_TRUE(best.covariance_given_rig.allFinite());
  EXPECT_TRUE(best.covariance.array().isNaN().all());
}

TEST(RefineBest, OfAnAverageHasTheSpreadAndTheLidarsOffset) {
  const auto samples = test::SynthesizeSamples(NoisyScene(4));
  const BestExtrinsic best = Best(test::Pointers(samples), RefineMethod::kAverage);
  EXPECT_EQ(best.T_camera_lidar.matrix(), RoughAverage().T_camera_lidar.matrix());
  EXPECT_GT(best.covariance_given_rig(5, 5), 0.02 * 0.02);
  EXPECT_LT(best.covariance_given_rig(3, 3), best.covariance_given_rig(5, 5));
}

// Boards behind the camera have no error in the image, and then neither has the mean over all.
TEST(RefineBest, LeavesAnAverageWhoseErrorIsUnknown) {
  const auto samples = test::SamplesWithSweeps(NoisyScene(12), kFaults);
  const auto all = test::Pointers(samples);
  double nearest_m = 1e9;
  for (const BoardSample& sample : samples) {
    nearest_m = std::min(nearest_m, sample.camera.pose.centre_m.z());
  }
  AveragedExtrinsic average = RoughAverage();
  average.T_camera_lidar.pretranslate(Eigen::Vector3d(0, 0, -nearest_m - 0.05));
  const BestExtrinsic best =
      RefineBest(all, test::TestBoard(), test::TestCamera(), average, {}, RefinerOptions{});
  ASSERT_TRUE(std::isnan(best.trials[0].ErrorMm()));
  ASSERT_TRUE(best.trials[2].problem.empty()) << best.trials[2].problem;
  EXPECT_NE(best.method, RefineMethod::kAverage);
  EXPECT_TRUE(best.IsUsable()) << best.problem;
}

TEST(RefineBest, ObeysANamedMethod) {
  const auto samples = test::SamplesWithSweeps(NoisyScene(10), kFaults);
  const auto all = test::Pointers(samples);
  EXPECT_EQ(Best(all, RefineMethod::kReprojection).method, RefineMethod::kReprojection);
  EXPECT_EQ(Best(all, RefineMethod::kAverage).method, RefineMethod::kAverage);
  const auto without_points = test::SynthesizeSamples({});
  EXPECT_EQ(Best(test::Pointers(without_points), RefineMethod::kLikelihood).problem,
            "most samples have no points of the board");
}

TEST(RefineBest, ScoresEachPoseByWhatTheOthersSay) {
  auto samples = test::SamplesWithSweeps(NoisyScene(12), kFaults);
  const BestExtrinsic before = Best(test::Pointers(samples), RefineMethod::kLikelihood);
  // The board of one pose moves, in the lidar's eyes, by 5 mm across the view: the fit without it
  // does not know, so its own error moves by all of that; one that was fitted to it would hide
  // some.
  const Eigen::Vector3d across_m(0.0, 0.005, 0.0);
  samples[3].lidar.pose.centre_m += across_m;
  for (Eigen::Vector3d& corner_m : samples[3].lidar.pose.corners_m) corner_m += across_m;
  const BestExtrinsic after = Best(test::Pointers(samples), RefineMethod::kLikelihood);
  ASSERT_THAT(after.held_out.poses, SizeIs(12));
  EXPECT_GT(after.held_out.poses[3].centre_mm, 5.0 - before.held_out.poses[3].centre_mm - 0.2);
}

// Wrong samples (the lidar saw another board) are found, and what is left holds the truth.
class RefineBestWithWrongSamples : public ::testing::TestWithParam<int> {};

TEST_P(RefineBestWithWrongSamples, StaysWithinItsInterval) {
  test::SyntheticSamplesOptions scene = NoisyScene(30);
  scene.num_outliers = 30 * GetParam() / 100;
  auto samples = test::SamplesWithSweeps(scene, kFaults);
  const Consistency consistency = FindConsistent(samples, {});
  EXPECT_THAT(consistency.inconsistent, SizeIs(static_cast<std::size_t>(scene.num_outliers)));
  std::vector<const BoardSample*> consistent;
  for (const int i : consistency.consistent) {
    EXPECT_GE(i, scene.num_outliers);
    consistent.push_back(&samples[static_cast<std::size_t>(i)]);
  }
  const BestExtrinsic best = Best(consistent);
  ASSERT_TRUE(best.IsUsable());
  const Vector6d error = DifferenceLeft(test::TestExtrinsic(), best.T_camera_lidar);
  // Three standard deviations: one of 18 numbers is beyond with a chance of 5 %, seeds are fixed.
  for (int i = 0; i < 6; ++i) {
    EXPECT_LT(std::abs(error[i]), 3.0 * std::sqrt(best.covariance_given_rig(i, i))) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Percent, RefineBestWithWrongSamples, ::testing::Values(10, 20, 30));

TEST(RefineBest, EndsInASentenceWherePosesCannotHoldAnExtrinsic) {
  test::SyntheticSamplesOptions parallel;
  parallel.max_tilt_rad = 0.0;
  test::SyntheticSamplesOptions one_place;
  one_place.spread = 0.0;
  for (const auto& scene : {parallel, one_place}) {
    const auto samples = test::SamplesWithSweeps(scene, kFaults);
    const BestExtrinsic best = Best(test::Pointers(samples));
    EXPECT_FALSE(best.IsUsable());
    EXPECT_THAT(best.problem, HasSubstr("all boards are"));
    EXPECT_TRUE(best.covariance.hasNaN());
  }
}

TEST(RefinerOptions, NamesProblemsOfItsParts) {
  EXPECT_THAT(RefinerOptions{}.Problems(), IsEmpty());
  RefinerOptions options;
  options.reprojection.huber_px = 0.0;
  options.likelihood.ring_prior_m = 0.0;
  EXPECT_THAT(options.Problems(), SizeIs(2));
  EXPECT_THROW(RefineBest({}, test::TestBoard(), test::TestCamera(), RoughAverage(), {}, options),
               std::invalid_argument);
}

TEST(RefineMethodFromString, TakesWhatToStringGives) {
  EXPECT_EQ(RefineMethodFromString(ToString(RefineMethod::kLikelihood)), RefineMethod::kLikelihood);
  EXPECT_EQ(RefineMethodFromString("best"), std::nullopt);
}

}  // namespace
}  // namespace voqcal
