#include "study/selector_scores.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

std::vector<BoardSample> Scene(int num_samples, double noise) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.lidar_rotation_noise_rad = 2 * noise;
  scene.lidar_centre_noise_m = noise;
  scene.edge_noise_m = noise;
  return test::SynthesizeSamples(scene);
}

Rig TestRig() {
  Rig rig;
  rig.board = test::TestBoard();
  rig.camera = test::TestCamera();
  return rig;
}

TEST(CrossValidate, FindsNoErrorInExactSamples) {
  for (const SelectionCriterion criterion : AllSelectionCriteria()) {
    const SelectorScore score = CrossValidate(Scene(6, 0.0), TestRig(), criterion);
    EXPECT_EQ(score.name, ToString(criterion));
    EXPECT_LT(score.average_mm.max, 1e-3);  // what the solvers leave
    EXPECT_LT(score.final_mm.max, 1e-3);
  }
}

TEST(CrossValidate, IsUnknownWhereThereIsNoExtrinsic) {
  // Three samples but one are two: no set.
  const SelectorScore score = CrossValidate(Scene(3, 0.0), TestRig(), SelectionCriterion::kVoq);
  EXPECT_TRUE(std::isnan(score.average_mm.mean));
  EXPECT_TRUE(std::isnan(score.final_mm.mean));
}

TEST(CrossValidate, ScoresEachSampleByTheExtrinsicOfTheOthers) {
  const auto samples = Scene(7, 0.008);
  double sum_mm = 0.0;
  for (const BoardSample& held_out : samples) {
    const SetExtrinsic of_others = EstimateSetExtrinsic(
        SamplesWithout(samples, {held_out.id}), test::TestCamera(), SetExtrinsicOptions{});
    sum_mm += ScorePose(held_out, test::TestCamera(), of_others.T_camera_lidar).centre_mm;
  }
  EXPECT_NEAR(CrossValidate(samples, TestRig(), SelectionCriterion::kAllPoses).average_mm.mean,
              sum_mm / 7,
              1e-6);  // the average of one extrinsic is that to rounding
}

TEST(RankCorrelations, FindPureNoiseByThePredictedError) {
  // Errors are noise of the size that the predictor expects: its order is far from chance, which
  // for 220 sets that share 12 poses is within about +- 0.3.
  const auto sets = StudyAllSets(Scene(12, 0.01), test::TestBoard(), test::TestCamera(), {});
  for (const RankCorrelation& each : RankCorrelations(sets)) {
    EXPECT_LE(std::abs(each.spearman), 1.0) << each.figure;
    if (each.figure == "scene_error") {
      EXPECT_GT(each.spearman, 0.3);
    }
  }
}

}  // namespace
}  // namespace voqcal
