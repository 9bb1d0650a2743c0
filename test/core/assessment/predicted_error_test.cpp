#include "core/assessment/predicted_error.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

TEST(PredictErrors, OfATurnGrowsWithRangeInMillimetresOnly) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(1, 1) = 1e-6;  // 1 mrad about the camera's y axis
  Eigen::Isometry3d T = test::TestExtrinsic();
  T.translation().setZero();  // turns about the camera itself
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  const auto errors = PredictErrors(T, covariance, camera);
  ASSERT_EQ(errors.size(), 6u);
  for (const PredictedError& error : errors) {
    // On the axis a turn of 1 mrad moves a point by 1 mm a metre and fx / 1000 pixels; the image's
    // middle is 2.5 px off the axis.
    EXPECT_NEAR(error.centre_mm, error.range_m, 0.01 * error.range_m);
    EXPECT_NEAR(error.centre_px, 0.42, 0.01);
  }
}

TEST(PredictErrors, OfAShiftFallsWithRangeInPixelsOnly) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(3, 3) = 1e-6;  // 1 mm along the camera's x axis
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  for (const PredictedError& error : PredictErrors(test::TestExtrinsic(), covariance, camera)) {
    EXPECT_NEAR(error.centre_mm, 1.0, 0.01);
    EXPECT_NEAR(error.centre_px, 0.42 / error.range_m, 0.01 / error.range_m);
  }
}

// The oracle: many extrinsics drawn from the covariance.
TEST(PredictErrors, AgreesWithSampling) {
  Matrix6d root = Matrix6d::Zero();
  test::Random random(3);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) root(i, j) = 1e-3 * random.Normal();
  }
  const CameraModel camera = test::TestCamera();
  const Eigen::Isometry3d T = test::TestExtrinsic();
  const PredictedError at_10_m = PredictErrors(T, root * root.transpose(), camera)[3];
  const Eigen::Vector3d ray =
      *camera.Unproject({(camera.width_px - 1) / 2.0, (camera.height_px - 1) / 2.0});
  const Eigen::Vector3d point_camera_m = at_10_m.range_m * ray;
  const Eigen::Vector3d point_lidar_m = T.inverse() * point_camera_m;
  constexpr int kNumDraws = 20000;
  double sum_px2 = 0;
  for (int i = 0; i < kNumDraws; ++i) {
    Vector6d z;
    for (int j = 0; j < 6; ++j) z[j] = random.Normal();
    const Eigen::Vector3d moved = PerturbLeft(T, root * z) * point_lidar_m;
    sum_px2 += (camera.Project(moved) - camera.Project(point_camera_m)).squaredNorm();
  }
  // A mean of squares of 20,000 draws is known to 1 %, its root to half of that; allow 3 sigma.
  const double rms_px = std::sqrt(sum_px2 / kNumDraws);
  EXPECT_NEAR(at_10_m.centre_px, rms_px, 0.015 * rms_px);
}

TEST(PredictErrors, CornersThatTheLensCannotSayAreUnknown) {
  CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  camera.distortion = {-0.6, 0, 0, 0, 0};  // folds back within the image
  const PredictedError error =
      PredictErrors(test::TestExtrinsic(), 1e-6 * Matrix6d::Identity(), camera)[0];
  EXPECT_GT(error.centre_px, 0);
  EXPECT_TRUE(std::isnan(error.corner_px));
  EXPECT_TRUE(std::isnan(error.corner_mm));
}

}  // namespace
}  // namespace voqcal
