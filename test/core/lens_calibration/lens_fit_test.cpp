#include "core/lens_calibration/lens_fit.hpp"

#include <cmath>
#include <filesystem>
#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>

#include "support/real_data.hpp"
#include "support/sanitizers.hpp"
#include "support/synthetic_lens_views.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

const std::vector<Eigen::Vector3d> kCornersBoardM = test::TestBoard().InnerCornersBoardM();

std::optional<LensFit> FitFromNothing(const LensForm& form,
                                      const cv::Size& image_px,
                                      const std::vector<LensView>& views) {
  const auto start = StartLens(form.lens, image_px, kCornersBoardM, views);
  if (!start) return {};
  return FitLens(form, kCornersBoardM, views, *start, 0.0);
}

cv::Size SizeOf(const CameraModel& camera) { return {camera.width_px, camera.height_px}; }

Eigen::VectorXd ErrorOf(const LensFit& fit, const CameraModel& truth) {
  Eigen::VectorXd error(fit.form.NumParameters());
  error.head<4>() << fit.camera.fx_px - truth.fx_px, fit.camera.fy_px - truth.fy_px,
      fit.camera.cx_px - truth.cx_px, fit.camera.cy_px - truth.cy_px;
  for (int i = 0; i < fit.form.num_free; ++i) {
    const auto k = static_cast<std::size_t>(i);
    error[4 + i] = fit.camera.distortion[k] - truth.distortion[k];
  }
  return error;
}

/// OpenCV's RMS on the same corners, of the lens with all of its coefficients.
double RmsOfOpenCv(LensModel lens, const cv::Size& image_px, const std::vector<LensView>& views) {
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> in_image;
  for (const LensView& view : views) {
    on_board.emplace_back();
    in_image.emplace_back();
    for (std::size_t i = 0; i < kCornersBoardM.size(); ++i) {
      const Eigen::Vector3f point = kCornersBoardM[i].cast<float>();
      const Eigen::Vector2f pixel = view.corners_px[i].cast<float>();
      on_board.back().emplace_back(point.x(), point.y(), 0.0F);
      in_image.back().emplace_back(pixel.x(), pixel.y());
    }
  }
  cv::Mat K;
  cv::Mat D;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  if (lens == LensModel::kEquidistant) {
    return cv::fisheye::calibrate(
        on_board,
        in_image,
        image_px,
        K,
        D,
        rotations,
        translations,
        cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW);
  }
  const int flags = lens == LensModel::kRational ? cv::CALIB_RATIONAL_MODEL : 0;
  return cv::calibrateCamera(on_board, in_image, image_px, K, D, rotations, translations, flags);
}

TEST(FitLens, IsExactOnCleanCorners) {
  for (const LensModel lens : test::kLenses) {
    const CameraModel truth = test::SmallCamera(lens);
    test::LensViewsOptions clean;
    clean.num_views = 12;
    clean.noise_px = 0;
    const auto fit =
        FitFromNothing(WholeForm(lens), SizeOf(truth), test::MakeLensViews(truth, clean));
    ASSERT_TRUE(fit) << ToString(lens);
    EXPECT_LT(fit->rms_px, 1e-4) << ToString(lens);
    EXPECT_NEAR(fit->camera.fx_px, truth.fx_px, 1e-3 * truth.fx_px) << ToString(lens);
  }
}

TEST(FitLens, IsWithinFourSigmaOfTheTruth) {
  for (const LensModel lens : test::kLenses) {
    const CameraModel truth = test::SmallCamera(lens);
    const auto fit = FitFromNothing(WholeForm(lens), SizeOf(truth), test::MakeLensViews(truth, {}));
    ASSERT_TRUE(fit) << ToString(lens);
    const Eigen::VectorXd error = ErrorOf(*fit, truth);
    // Of the rational model's coefficients other sets give the same lens.
    const bool are_told_apart = lens != LensModel::kRational;
    for (int i = 0; i < (are_told_apart ? error.size() : 4); ++i) {
      EXPECT_LT(std::abs(error[i]), 4 * fit->Sigma(i)) << ToString(lens) << ' ' << i;
    }
    // Both coordinates of 0.2 px, less the share that 35 corners' pose takes of it.
    EXPECT_NEAR(fit->rms_px, 0.2 * std::sqrt(2 * 64.0 / 70.0), 0.02) << ToString(lens);
  }
}

// Boards with markers: of each a part.
TEST(FitLens, TakesWhatOfABoardIsSeen) {
  const CameraModel truth = test::SmallCamera(LensModel::kPlumbBob);
  test::LensViewsOptions options;
  options.num_views = 16;
  std::vector<LensView> views = test::MakeLensViews(truth, options);
  test::Random random(3);
  for (LensView& view : views) {
    for (Eigen::Vector2d& corner_px : view.corners_px) {
      if (random.Uniform(0, 1) < 0.4) corner_px.setConstant(std::nan(""));
    }
  }
  const auto fit = FitFromNothing(WholeForm(truth.lens), SizeOf(truth), views);
  ASSERT_TRUE(fit);
  const Eigen::VectorXd error = ErrorOf(*fit, truth);
  for (int i = 0; i < error.size(); ++i) EXPECT_LT(std::abs(error[i]), 4 * fit->Sigma(i)) << i;
}

// The real camera's lens, 30 poses, corners to 0.2 px: fx to a thousandth, and its intervals hold.
TEST(FitLens, KnowsHowWellItKnowsTheLens) {
  VOQCAL_LEAVE_TO_RELEASE();
  constexpr int kNumSeeds = 40;
  const CameraModel truth = test::RealCamera();
  double nees = 0;
  double squares = 0;
  int num_within = 0;
  for (int seed = 1; seed <= kNumSeeds; ++seed) {
    test::LensViewsOptions options;
    options.seed = static_cast<std::uint32_t>(seed);
    const auto fit =
        FitFromNothing(WholeForm(truth.lens), SizeOf(truth), test::MakeLensViews(truth, options));
    ASSERT_TRUE(fit) << seed;
    const Eigen::VectorXd error = ErrorOf(*fit, truth);
    nees += error.dot(fit->covariance.ldlt().solve(error)) / kNumSeeds;
    squares += std::pow(error[0] / truth.fx_px, 2) / kNumSeeds;
    num_within += std::abs(error[0]) < 1.96 * fit->Sigma(0) ? 1 : 0;
  }
  std::cout << "fx RMS error " << 100 * std::sqrt(squares) << " %, within 95 %: " << num_within
            << " of " << kNumSeeds << ", NEES " << nees << " of 8 parameters\n";
  EXPECT_LT(std::sqrt(squares), 1e-3);
  EXPECT_GE(num_within, 34);  // 95 % of 40 is 38; fewer than 34 has a probability of 0.3 %
  // 8 if sigmas were exact, with a standard error of sqrt(2 * 8 / 40) = 0.6. The allowance for what
  // views share makes it less.
  EXPECT_GT(nees, 4.0);
  EXPECT_LT(nees, 10.0);
}

TEST(FitLens, FitsNoWorseThanOpenCv) {
  VOQCAL_LEAVE_TO_RELEASE();
  for (const LensModel lens : test::kLenses) {
    const CameraModel truth = test::SmallCamera(lens);
    const auto views = test::MakeLensViews(truth, {});
    const auto fit = FitFromNothing(WholeForm(lens), SizeOf(truth), views);
    ASSERT_TRUE(fit) << ToString(lens);
    // It stops where a step changes little, and reads corners as floats.
    EXPECT_LT(fit->rms_px, RmsOfOpenCv(lens, SizeOf(truth), views) + 1e-4) << ToString(lens);
  }
}

TEST(FitLens, FitsTheRealSessionNoWorseThanOpenCv) {
  VOQCAL_LEAVE_TO_RELEASE();
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  const CameraModel camera = test::RealCamera();
  std::vector<LensView> views;
  for (const auto& file : std::filesystem::directory_iterator(*data / "acfr-vlp16" / "images")) {
    const cv::Mat grey = cv::imread(file.path(), cv::IMREAD_GRAYSCALE);
    auto view = SeeLensView(grey, test::TestBoard(), 0);
    ASSERT_TRUE(view) << file.path();
    views.push_back(*view);
  }
  ASSERT_EQ(views.size(), 30U);
  const auto fit = FitFromNothing(WholeForm(camera.lens), SizeOf(camera), views);
  ASSERT_TRUE(fit);
  const double opencv_px = RmsOfOpenCv(camera.lens, SizeOf(camera), views);
  std::cout << "RMS " << fit->rms_px << " px, cv::fisheye::calibrate's " << opencv_px << '\n';
  EXPECT_LT(fit->rms_px, opencv_px + 1e-4);
}

TEST(FitLens, SaysThatFlatViewsTellNoFocalLength) {
  const CameraModel truth = test::SmallCamera(LensModel::kPlumbBob);
  test::LensViewsOptions flat;
  flat.max_tilt_rad = 0;
  const auto fit =
      FitFromNothing({LensModel::kPlumbBob, 2}, SizeOf(truth), test::MakeLensViews(truth, flat));
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->scale_sigma, 0.02);
}

TEST(LensForm, HasAName) {
  EXPECT_EQ(ToString(WholeForm(LensModel::kRational)), "rational");
  EXPECT_EQ(ToString(LensForm{LensModel::kPlumbBob, 2}), "plumb_bob with 2 coefficients");
}

}  // namespace
}  // namespace voqcal
