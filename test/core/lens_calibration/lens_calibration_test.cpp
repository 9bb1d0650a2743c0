#include "core/lens_calibration/lens_calibration.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/sanitizers.hpp"
#include "support/synthetic_lens_views.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

LensCalibration Calibrate(const CameraModel& truth,
                          const std::vector<LensView>& views,
                          const std::optional<LensModel>& lens) {
  LensCalibrationOptions options;
  options.lens = lens;
  return CalibrateLens(views, test::TestBoard(), {truth.width_px, truth.height_px}, options);
}

TEST(CalibrateLens, LeavesOutAWrongImage) {
  const CameraModel truth = test::SmallCamera(LensModel::kPlumbBob);
  test::LensViewsOptions options;
  options.num_views = 16;
  std::vector<LensView> views = test::MakeLensViews(truth, options);
  // A grid that was put together from the wrong corners: its last row is one square off.
  for (std::size_t i = 30; i + 1 < 35; ++i) views[4].corners_px[i] = views[4].corners_px[i + 1];
  const LensCalibration found = Calibrate(truth, views, truth.lens);
  EXPECT_EQ(found.refusal, "");
  ASSERT_EQ(found.odd.size(), 1U);
  EXPECT_EQ(found.odd[0].utime, views[4].utime);
  EXPECT_GT(found.odd_rms_px[0], 3.0);
  ASSERT_TRUE(found.best);
  EXPECT_NEAR(found.best->fit.camera.fx_px, truth.fx_px, 4 * found.best->fit.Sigma(0));
  EXPECT_LT(found.best->fit.rms_px, 0.3);
  EXPECT_GT(found.best->held_out.rms_px, found.best->fit.rms_px);
  EXPECT_LT(found.best->held_out.rms_px, 1.2 * found.best->fit.rms_px);
  // A lens that is wrong by two hundredths predicts worse than the one found.
  CameraModel wrong = truth;
  wrong.fx_px *= 1.02;
  const double wrong_px = ErrorsOfLens(wrong, test::TestBoard(), found.views).rms_px;
  EXPECT_GT(wrong_px, found.best->held_out.rms_px);
}

TEST(CalibrateLens, RefusesTooFewPoses) {
  const CameraModel truth = test::SmallCamera(LensModel::kPlumbBob);
  test::LensViewsOptions options;
  options.num_views = 7;
  const LensCalibration found = Calibrate(truth, test::MakeLensViews(truth, options), truth.lens);
  EXPECT_THAT(found.refusal, HasSubstr("7 images of different poses can be used, 8 are needed"));
  EXPECT_FALSE(found.best);
}

TEST(CalibrateLens, RefusesBoardsThatAllFaceTheCamera) {
  const CameraModel truth = test::SmallCamera(LensModel::kPlumbBob);
  test::LensViewsOptions flat;
  flat.num_views = 10;
  flat.max_tilt_rad = 0;
  const LensCalibration found = Calibrate(truth, test::MakeLensViews(truth, flat), truth.lens);
  EXPECT_THAT(found.refusal,
              AllOf(HasSubstr("is not determined"), HasSubstr("tilt the board by 20 to 45")));
}

TEST(CalibrateLens, RefusesWhatNoLensExplains) {
  const CameraModel truth = test::SmallCamera(LensModel::kPlumbBob);
  test::LensViewsOptions noisy;
  noisy.num_views = 10;
  noisy.noise_px = 3;
  const LensCalibration found = Calibrate(truth, test::MakeLensViews(truth, noisy), truth.lens);
  EXPECT_THAT(found.refusal, HasSubstr("the RMS is"));
}

// What was done to the images, as far as their lens tells it.
TEST(CalibrateLens, RefusesImagesThatWereSqueezedOrCut) {
  const auto refusal_of = [](const CameraModel& camera) {
    test::LensViewsOptions options;
    options.num_views = 20;
    return Calibrate(camera, test::MakeLensViews(camera, options), camera.lens).refusal;
  };
  CameraModel squeezed = test::SmallCamera(LensModel::kPlumbBob);
  squeezed.fy_px *= 0.75;
  EXPECT_THAT(refusal_of(squeezed), HasSubstr("if the images were squeezed to another shape"));
  CameraModel cut = test::SmallCamera(LensModel::kPlumbBob);
  cut.cx_px = 0.1 * cut.width_px;
  EXPECT_THAT(refusal_of(cut), HasSubstr("if the images were cut on one side"));
}

TEST(CalibrateLens, NamesBadOptions) {
  LensCalibrationOptions options;
  options.num_groups = 1;
  options.max_sigma = 0;
  EXPECT_THAT(options.Problems(), testing::SizeIs(2));
  EXPECT_THROW(CalibrateLens({}, test::TestBoard(), {640, 480}, options), std::invalid_argument);
}

TEST(CalibrateLens, NamesThePartsOfTheImageWithoutACorner) {
  const CameraModel truth = test::SmallCamera(LensModel::kPlumbBob);
  test::LensViewsOptions options;
  options.num_views = 60;
  std::vector<LensView> left;
  for (const LensView& view : test::MakeLensViews(truth, options)) {
    bool is_left = true;
    for (const Eigen::Vector2d& corner_px : view.corners_px) {
      is_left = is_left && corner_px.x() < 2 * truth.width_px / 3.0 - 1;
    }
    if (is_left) left.push_back(view);
  }
  const LensCalibration found = Calibrate(truth, left, truth.lens);
  EXPECT_THAT(found.advice, Contains(HasSubstr("top right, right, bottom right: show the board")));
  EXPECT_EQ(found.coverage.num_corners[5], 0);
  EXPECT_GT(found.coverage.num_corners[4], 0);
}

TEST(CalibrateLens, ChoosesTheSimplestModelThatPredictsAsWell) {
  VOQCAL_LEAVE_TO_RELEASE();
  CameraModel simple = test::SmallCamera(LensModel::kPlumbBob);
  simple.distortion = {-0.2, 0.05};
  const LensCalibration by_simple = Calibrate(simple, test::MakeLensViews(simple, {}), {});
  ASSERT_TRUE(by_simple.best);
  EXPECT_EQ(ToString(by_simple.best->fit.form), "plumb_bob with 2 coefficients");
  EXPECT_EQ(by_simple.trials.size(), LensForms().size());
  EXPECT_THAT(by_simple.odd, IsEmpty());

  CameraModel fisheye = test::SmallCamera(LensModel::kEquidistant);
  fisheye.fx_px = fisheye.fy_px = 220;  // 165 degrees
  fisheye.distortion = {-0.02, 0.003, -0.001, 0};
  const LensCalibration by_fisheye = Calibrate(fisheye, test::MakeLensViews(fisheye, {}), {});
  ASSERT_TRUE(by_fisheye.best);
  EXPECT_EQ(ToString(by_fisheye.best->fit.form), "equidistant");
  EXPECT_EQ(by_fisheye.refusal, "");
}

}  // namespace
}  // namespace voqcal
