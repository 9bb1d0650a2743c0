#include "core/camera_detection/planar_pose.hpp"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "core/board/board_spec.hpp"
#include "support/matchers.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

const std::vector<Eigen::Vector3d> kPointsBoardM =
    BoardSpec{0.61, 0.85, 0.095, 5, 7, 0.002, 0}.InnerCornersBoardM();

Eigen::Isometry3d BoardAhead(const Eigen::Vector3d& tilt_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3(tilt_rad) * ExpSO3({M_PI, 0, 0}) * ExpSO3({0, 0, 0.5});
  T.translation() << 0.1, -0.05, 1.8;
  return T;
}

std::vector<Eigen::Vector2d> PixelsOf(const CameraModel& camera, const Eigen::Isometry3d& T) {
  std::vector<Eigen::Vector2d> pixels_px;
  for (const auto& point : kPointsBoardM) pixels_px.push_back(camera.Project(T * point));
  return pixels_px;
}

TEST(FitPlanarPose, IsExactOnExactPixelsOfEachLens) {
  for (const LensModel lens : test::kLenses) {
    const CameraModel camera = test::SmallCamera(lens);
    for (const Eigen::Vector3d& tilt_rad :
         {Eigen::Vector3d(0.2, -0.4, 0), Eigen::Vector3d(-0.7, 0.5, 0), Eigen::Vector3d(0, 0, 0)}) {
      const Eigen::Isometry3d T = BoardAhead(tilt_rad);
      const auto fit = FitPlanarPose(camera, kPointsBoardM, PixelsOf(camera, T));
      ASSERT_TRUE(fit) << ToString(lens);
      EXPECT_LT(fit->reprojection_rms_px, 1e-6) << ToString(lens);
      // 1e-6 px at 420 px a radian, and 100 times that for tilts near to facing the camera.
      EXPECT_THAT(fit->T_camera_board, test::IsNear(T, 1e-6, 1e-6)) << ToString(lens);
    }
  }
}

TEST(FitPlanarPose, CovarianceIsTheSpreadOverNoisyTrials) {
  constexpr int kNumTrials = 100;
  const CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  const Eigen::Isometry3d T = BoardAhead({0.3, -0.4, 0});
  std::mt19937 random(11);
  std::normal_distribution<double> noise_px(0, 0.2);
  double sum = 0;
  for (int trial = 0; trial < kNumTrials; ++trial) {
    auto pixels_px = PixelsOf(camera, T);
    for (auto& pixel : pixels_px) pixel += Eigen::Vector2d(noise_px(random), noise_px(random));
    const auto fit = FitPlanarPose(camera, kPointsBoardM, pixels_px);
    ASSERT_TRUE(fit);
    const Vector6d error = DifferenceLeft(T, fit->T_camera_board);
    sum += error.dot(fit->covariance.ldlt().solve(error));
  }
  // The squared error over 6 and the estimated variance is F(6, 64): mean 64 / 62, variance of the
  // mean of 100 trials 2 x 1.03^2 x (6 + 62) / (6 x 60) / 100 = 0.063^2. Allow 3 of these.
  EXPECT_NEAR(sum / 6 / kNumTrials, 64.0 / 62.0, 0.19);
}

TEST(FitPlanarPose, SaysHowProbableTheMirroredTiltIs) {
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  std::mt19937 engine(3);
  const auto mirrored_probability = [&](double distance_m) {
    Eigen::Isometry3d T = BoardAhead({0.5, 0, 0});
    T.translation() *= distance_m / T.translation().norm();
    auto pixels_px = PixelsOf(camera, T);
    for (auto& pixel : pixels_px) {  // even noise of 0.12 px rms an axis
      pixel.x() += 0.4 * (static_cast<double>(engine() % 1000) / 999 - 0.5);
      pixel.y() += 0.4 * (static_cast<double>(engine() % 1000) / 999 - 0.5);
    }
    const auto fit = FitPlanarPose(camera, kPointsBoardM, pixels_px);
    return fit ? fit->mirrored_probability : -1.0;
  };
  // The pattern's farther edge is smaller by the share 0.57 m sin(0.5) / distance: at 2 m by 13 %
  // of its 80 px, at 30 m by 0.9 % of 5 px, a half of the noise.
  EXPECT_LT(mirrored_probability(2), 1e-6);
  EXPECT_GE(mirrored_probability(2), 0);
  EXPECT_GT(mirrored_probability(30), 0.01);
}

TEST(FitPlanarPose, PutsTheFaceTowardsTheCamera) {
  // Mirrored pixels are those of the board seen from behind: no pose in front explains them well.
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  auto pixels_px = PixelsOf(camera, BoardAhead({0.3, -0.4, 0}));
  for (auto& pixel : pixels_px) pixel.x() = camera.width_px - pixel.x();
  const auto fit = FitPlanarPose(camera, kPointsBoardM, pixels_px);
  EXPECT_TRUE(!fit || fit->reprojection_rms_px > 5);
}

TEST(FitPlanarPose, HasNoPoseForDegeneratePixels) {
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  const std::vector<Eigen::Vector2d> one_pixel(kPointsBoardM.size(), Eigen::Vector2d(300, 200));
  EXPECT_FALSE(FitPlanarPose(camera, kPointsBoardM, one_pixel));
  CameraModel folded = camera;  // every pixel of the board lies beyond the largest distorted radius
  folded.distortion = {-1000};
  const auto pixels_px = PixelsOf(camera, BoardAhead({0, 0, 0}));
  EXPECT_FALSE(FitPlanarPose(folded, kPointsBoardM, pixels_px));
}

}  // namespace
}  // namespace voqcal
