#include "core/calibration/calibrate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/matchers.hpp"
#include "support/synthetic_samples.hpp"
#include "support/with_helpers.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const CalibrationTask kTask{test::TestBoard(), test::TestCamera(), {}};

test::SyntheticSamplesOptions NoisyScene() {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = 20;
  scene.lidar_centre_noise_m = 0.002;
  scene.lidar_rotation_noise_rad = 0.003;
  scene.edge_noise_m = 0.002;
  return scene;
}

TEST(Calibrate, FindsTheExtrinsicAndSaysWhatItIsMadeFrom) {
  test::SyntheticSamplesOptions scene = NoisyScene();
  scene.num_outliers = 2;
  const auto outcome = Calibrate(test::SynthesizeSamples(scene), {}, kTask);
  ASSERT_EQ(outcome.problem, "");
  const Calibration& calibration = outcome.calibration;
  // 3 mrad and 2 mm a pose over 18 poses: 0.7 mrad and 0.5 mm on each axis; allow 4 sigma.
  EXPECT_THAT(calibration.T_camera_lidar, test::IsNear(test::TestExtrinsic(), 3e-3, 6e-3));
  EXPECT_THAT(calibration.used_ids, SizeIs(18));
  EXPECT_THAT(calibration.rejected, SizeIs(2));
  EXPECT_EQ(calibration.averaged.num_sets, 50);
  EXPECT_EQ(calibration.scene_check.verdict, Agreement::kCannotTell);
}

TEST(Calibrate, IsItsSteps) {
  const auto samples = test::SynthesizeSamples(NoisyScene());
  const auto outcome = Calibrate(samples, {}, kTask);
  const ChosenSamples chosen = ChooseSamples(samples, kTask.camera, kTask.options.consistency);
  const ChosenSets sets = ChooseSets(chosen, kTask);
  const AveragedSets averaged = AverageSets(chosen.Used(), sets.sets, kTask);
  const BestExtrinsic refined = RefineBest(
      chosen.Used(), kTask.board, kTask.camera, averaged.average, {}, kTask.options.refinement);
  EXPECT_EQ(outcome.calibration.T_camera_lidar.matrix(), refined.T_camera_lidar.matrix());
  EXPECT_EQ(outcome.averaged.average.T_camera_lidar.matrix(),
            averaged.average.T_camera_lidar.matrix());
}

TEST(Calibrate, SaysWhichStepGaveNothing) {
  const auto samples = test::SynthesizeSamples(NoisyScene());
  const auto two = Calibrate({samples[0], samples[1]}, {}, kTask);
  EXPECT_EQ(two.problem, "fewer than three samples that agree with each other: 2 of 2");

  test::SyntheticSamplesOptions parallel;
  parallel.max_tilt_rad = 0.0;
  const auto one_way = Calibrate(test::SynthesizeSamples(parallel), {}, kTask);
  EXPECT_THAT(one_way.problem, HasSubstr("all boards face the same way"));
  EXPECT_THAT(one_way.calibration.used_ids, IsEmpty());
}

// The board rested at the first place for a third of the session: there, a pair's sweep and the
// next pair's are alike, and all others contradict one another.
TEST(Calibrate, AsksWhyMostSamplesContradictTheFewThatAgree) {
  test::SyntheticSamplesOptions scene = NoisyScene();
  scene.num_samples = 15;
  auto samples = test::SynthesizeSamples(scene);
  const BoardSample first = samples.front();
  for (std::size_t i = 0; i < 5; ++i) {
    const std::int64_t id = samples[i].id;
    samples[i] = first;
    samples[i].id = id;
  }
  for (std::size_t i = samples.size() - 1; i > 0; --i) samples[i].lidar = samples[i - 1].lidar;
  const auto outcome = Calibrate(samples, {}, kTask);
  EXPECT_THAT(outcome.problem,
              AllOf(HasSubstr("of 15, are too alike"), HasSubstr("likely cause: shifted pairs")));
}

TEST(Calibrate, GivesTheSameOnAnyNumberOfThreads) {
  const auto samples = test::SynthesizeSamples(NoisyScene());
  const auto calibrate = [&](std::size_t num_helpers) {
    const test::WithHelpers helpers(num_helpers);
    return Calibrate(samples, {}, kTask).calibration;
  };
  const Calibration alone = calibrate(0);
  const Calibration helped = calibrate(3);
  EXPECT_EQ(alone.T_camera_lidar.matrix(), helped.T_camera_lidar.matrix());
  EXPECT_EQ(alone.covariance_given_rig, helped.covariance_given_rig);
  ASSERT_THAT(alone.trials, SizeIs(4));
  ASSERT_EQ(alone.trials[1].problem, "");  // the reprojection, which is tried with each left out
  EXPECT_GT(alone.trials[1].ErrorMm(), 0.0);
  EXPECT_EQ(alone.trials[1].ErrorMm(), helped.trials[1].ErrorMm());
}

TEST(ChooseSets, ComparesWithThePublishedCriterion) {
  CalibrationTask task = kTask;
  task.options.selection.criterion = SelectionCriterion::kAllPoses;
  const ChosenSamples chosen =
      ChooseSamples(test::SynthesizeSamples(NoisyScene()), task.camera, task.options.consistency);
  const ChosenSets sets = ChooseSets(chosen, task);
  EXPECT_THAT(sets.sets, SizeIs(1));
  EXPECT_THAT(sets.lowest_voq, SizeIs(50));
}

TEST(ChosenSamples, UsesWhatWasNotRejected) {
  ChosenSamples chosen{test::SynthesizeSamples(NoisyScene()), {}, {}};
  chosen.rejected.push_back({chosen.samples[3].id, "moved"});
  EXPECT_THAT(chosen.Used(), SizeIs(19));
  EXPECT_EQ(chosen.Used()[3], &chosen.samples[4]);
}

TEST(VerdictOf, IsBadWithoutEvidence) { EXPECT_EQ(VerdictOf(Calibration{}).grade, Grade::kBad); }

}  // namespace
}  // namespace voqcal
