#include "core/assessment/lens_correction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/camera/lens_errors.hpp"
#include "support/sanitizers.hpp"
#include "support/synthetic_lens.hpp"
#include "support/synthetic_sweeps.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr int kNumSamples = 12;  // leave-one-out costs their square

std::vector<BoardSample> SamplesThrough(const LensErrors& errors) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = kNumSamples;
  scene.lidar_centre_noise_m = 0.002;
  scene.lidar_rotation_noise_rad = 0.003;
  auto samples = test::SamplesWithSweeps(scene, {0.02, 0.015, 0.008, 0.01});
  test::SeeThrough(CorrectedCamera(test::TestCamera(), errors), test::TestCamera(), 0.2, &samples);
  return samples;
}

struct Outcome {
  BestExtrinsic given;
  LensCorrection corrected;
};

Outcome Correct(const std::vector<BoardSample>& samples) {
  AveragedExtrinsic average;
  average.T_camera_lidar = test::TestExtrinsic();
  Outcome outcome;
  const auto all = test::Pointers(samples);
  outcome.given =
      RefineBest(all, test::TestBoard(), test::TestCamera(), average, {}, RefinerOptions{});
  outcome.corrected = CorrectLens(all,
                                  test::TestBoard(),
                                  test::TestCamera(),
                                  outcome.given.T_camera_lidar,
                                  outcome.given.held_out,
                                  LikelihoodOptions{});
  return outcome;
}

TEST(CorrectLens, LowersHeldOutErrorsOfAWrongLens) {
  VOQCAL_LEAVE_TO_RELEASE();
  LensErrors errors;
  errors << 0.006, 0.001, 0.004, -0.005, -0.008, 0.005;
  const Outcome outcome = Correct(SamplesThrough(errors));
  ASSERT_TRUE(outcome.corrected.IsUsable()) << outcome.corrected.problem;
  EXPECT_THAT(outcome.corrected.held_out.poses, SizeIs(kNumSamples));
  EXPECT_LT(outcome.corrected.held_out.corner_mm.mean, outcome.given.held_out.corner_mm.mean);
  const CameraModel truth = CorrectedCamera(test::TestCamera(), errors);
  const LensErrors three_sigma = 3.0 * outcome.corrected.errors.standard_errors;
  const double reach_px = LensReachPx(truth);
  EXPECT_NEAR(
      outcome.corrected.camera.cx_px, truth.cx_px, reach_px * three_sigma[kPrincipalPointX]);
  EXPECT_NEAR(
      outcome.corrected.camera.cy_px, truth.cy_px, reach_px * three_sigma[kPrincipalPointY]);
  EXPECT_TRUE(outcome.corrected.camera.Problems().empty());
}

TEST(CorrectLens, LeavesTheRightLensAlone) {
  const Outcome outcome = Correct(SamplesThrough(LensErrors::Zero()));
  EXPECT_FALSE(outcome.corrected.IsUsable());
  EXPECT_THAT(outcome.corrected.problem, HasSubstr("hardly better"));
}

TEST(WhichToTake, SaysHowFarTheTwoAreApart) {
  LensCorrection correction;
  EXPECT_EQ(WhichToTake(correction, test::TestExtrinsic()), "");
  correction.problem.clear();
  Vector6d move;
  move << 0.01, 0, 0, 0, 0.012, 0;
  correction.T_camera_lidar = PerturbLeft(test::TestExtrinsic(), move);
  const std::string words = WhichToTake(correction, test::TestExtrinsic());
  EXPECT_THAT(words, HasSubstr("turned by 0.57 deg and shifted by 12.0 mm"));
}

TEST(OtherLens, SaysWhichAndWhatItGains) {
  LensCorrection correction;
  EXPECT_EQ(OtherLens(correction, {}), "");
  correction.problem.clear();
  correction.camera = test::TestCamera();
  correction.errors.errors[kFocalLength] = 0.0067;
  correction.held_out.corner_mm.mean = 5.2;
  SceneScore without;
  without.corner_mm.mean = 7.0;
  EXPECT_THAT(OtherLens(correction, without),
              AllOf(HasSubstr("focal length +0.67 %"),
                    HasSubstr("err by 5.2 mm with it, by 7.0 mm with the rig file's")));
}

TEST(CorrectLens, SaysWhatItLacks) {
  auto samples = SamplesThrough(LensErrors::Zero());
  samples.front().camera.corners_px.clear();
  const LensCorrection corrected = CorrectLens(test::Pointers(samples),
                                               test::TestBoard(),
                                               test::TestCamera(),
                                               test::TestExtrinsic(),
                                               SceneScore{},
                                               LikelihoodOptions{});
  EXPECT_THAT(corrected.problem, HasSubstr("pixels"));
}

}  // namespace
}  // namespace voqcal
