#include "core/assessment/worst_error.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/assessment/predicted_error.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Matrix6d SomeCovariance(std::uint32_t seed) {
  test::Random random(seed);
  Matrix6d root = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) root(i, j) = 1e-3 * random.Normal();
  }
  return root * root.transpose();
}

double ErrorAt(const Eigen::Vector3d& point_camera_m, const Matrix6d& covariance, ErrorUnit unit) {
  const PointErrorForms forms =
      ErrorFormsAt(point_camera_m, test::TestExtrinsic(), test::TestCamera());
  return unit == ErrorUnit::kMillimetres ? 1e3 * std::sqrt((forms.m2 * covariance).trace())
                                         : std::sqrt((forms.px2 * covariance).trace());
}

// The oracle: points drawn from the whole scene.
TEST(WorstOfErrorScene, IsAsLargeAsAnyPointsOfTheScene) {
  const CameraModel camera = test::TestCamera();
  test::Random random(5);
  for (const ErrorUnit unit : {ErrorUnit::kMillimetres, ErrorUnit::kPixels}) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const Matrix6d covariance = SomeCovariance(seed);
      const ErrorTolerance tolerance{5.0, unit, 1.0, 8.0};
      const WorstError worst =
          ErrorScene(camera, test::TestExtrinsic(), tolerance).Worst(covariance);
      for (int i = 0; i < 2000; ++i) {
        const auto ray = camera.Unproject(
            {random.Uniform(0, camera.width_px - 1), random.Uniform(0, camera.height_px - 1)});
        ASSERT_TRUE(ray);
        const double error = ErrorAt(random.Uniform(1.0, 8.0) * *ray, covariance, unit);
        // Between points of the grid errors may be larger by what they curve: a few percent.
        EXPECT_LE(error, 1.03 * worst.error);
      }
      EXPECT_NEAR(ErrorAt(worst.point_camera_m, covariance, unit), worst.error, 1e-9);
      EXPECT_NEAR(worst.point_camera_m.norm(), worst.range_m, 1e-9);
      EXPECT_LT((camera.Project(worst.point_camera_m) - worst.pixel_px).norm(), 1e-6);
    }
  }
}

TEST(WorstOfErrorScene, OfATurnIsFarAwayInMillimetresOfAShiftNearInPixels) {
  const CameraModel camera = test::TestCamera();
  Matrix6d turn = Matrix6d::Zero();
  turn(1, 1) = 1e-6;
  Matrix6d shift = Matrix6d::Zero();
  shift(3, 3) = 1e-6;
  const ErrorScene in_mm(camera, test::TestExtrinsic(), {5.0, ErrorUnit::kMillimetres, 1.0, 8.0});
  EXPECT_EQ(in_mm.Worst(turn).range_m, 8.0);
  // On the axis 1 mrad about the camera's y moves 8 mm at 8 m, but for the lidar's 8 cm of lever.
  EXPECT_NEAR(in_mm.Worst(turn).error, 8.0, 0.1);
  const ErrorScene in_px(camera, test::TestExtrinsic(), {1.0, ErrorUnit::kPixels, 1.0, 8.0});
  EXPECT_EQ(in_px.Worst(shift).range_m, 1.0);
}

TEST(ErrorTolerance, NamesEachProblem) {
  EXPECT_THAT(ErrorTolerance{}.Problems(), ElementsAre());
  const ErrorTolerance bad{0.0, ErrorUnit::kPixels, 3.0, 2.0};
  EXPECT_THAT(bad.Problems(),
              ElementsAre(HasSubstr("tolerance must be positive, is 0"),
                          HasSubstr("max_range_m must be at least min_range_m, is 2")));
  EXPECT_THROW(ErrorScene(test::TestCamera(), test::TestExtrinsic(), bad), std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
