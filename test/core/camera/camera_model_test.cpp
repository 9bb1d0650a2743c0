#include "core/camera/camera_model.hpp"

#include <cmath>

#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

// OpenCV's answer, an implementation that shares nothing with ours.
Eigen::Vector2d ProjectByOpenCv(const CameraModel& camera, const Eigen::Vector3d& point) {
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const std::vector<double> distortion(camera.distortion.begin(),
                                       camera.distortion.begin() + NumDistortion(camera.lens));
  const std::vector<cv::Point3d> points{{point.x(), point.y(), point.z()}};
  std::vector<cv::Point2d> pixels;
  const cv::Vec3d zero(0, 0, 0);
  if (camera.lens == LensModel::kEquidistant) {
    cv::fisheye::projectPoints(points, pixels, zero, zero, K, distortion);
  } else {
    cv::projectPoints(points, zero, zero, K, distortion, pixels);
  }
  return {pixels[0].x, pixels[0].y};
}

TEST(Project, AgreesWithOpenCv) {
  for (const LensModel lens : test::kLenses) {
    const CameraModel camera = test::SmallCamera(lens);
    for (double x = -0.6; x <= 0.6; x += 0.15) {
      for (double y = -0.45; y <= 0.45; y += 0.15) {
        const Eigen::Vector3d point = 2.0 * Eigen::Vector3d(x, y, 1);
        EXPECT_LT((camera.Project(point) - ProjectByOpenCv(camera, point)).norm(), 1e-9)
            << ToString(lens) << " " << point.transpose();
      }
    }
  }
}

TEST(Project, DifferentiatesAsNumbersDo) {
  using Jet = ceres::Jet<double, 3>;
  constexpr double kStep = 1e-6;
  for (const LensModel lens : test::kLenses) {
    const CameraModel camera = test::SmallCamera(lens);
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0.5, -0.3, 1.2), Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1e-9, 0, 2)}) {
      const Eigen::Matrix<Jet, 3, 1> jets(Jet(point.x(), 0), Jet(point.y(), 1), Jet(point.z(), 2));
      const Eigen::Matrix<Jet, 2, 1> pixel = camera.Project(jets);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
        const Eigen::Vector3d ahead = point + step;
        const Eigen::Vector3d behind = point - step;
        const Eigen::Vector2d slope =
            (camera.Project(ahead) - camera.Project(behind)) / (2 * kStep);
        // Central differences of 300 px: rounding 300 * 2e-16 / 1e-6 = 6e-8; allow 10 x.
        EXPECT_NEAR(pixel(0).v[k], slope.x(), 6e-7) << ToString(lens) << " " << k;
        EXPECT_NEAR(pixel(1).v[k], slope.y(), 6e-7) << ToString(lens) << " " << k;
      }
    }
  }
}

void ExpectRoundTrip(const CameraModel& camera) {
  for (int y = 0; y < camera.height_px; y += 31) {
    for (int x = 0; x < camera.width_px; x += 31) {
      const Eigen::Vector2d pixel(x, y);
      const auto ray = camera.Unproject(pixel);
      ASSERT_TRUE(ray) << ToString(camera.lens) << " " << pixel.transpose();
      EXPECT_NEAR(ray->norm(), 1.0, 1e-14);
      EXPECT_TRUE(camera.IsInFront(*ray));
      EXPECT_LT((camera.Project(*ray) - pixel).norm(), 1e-9);
    }
  }
}

TEST(Unproject, InvertsProjectOverTheWholeImage) {
  ExpectRoundTrip(test::RealCamera());
  for (const LensModel lens : test::kLenses) ExpectRoundTrip(test::SmallCamera(lens));
}

TEST(Unproject, HasNoRayBeyondTheLargestDistortedRadius) {
  CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  camera.distortion = {-0.2};
  // r (1 - 0.2 r^2) is largest at r = sqrt(1 / 0.6), where it is 2 r / 3 = 0.8607.
  EXPECT_TRUE(camera.Unproject({camera.cx_px + 0.86 * camera.fx_px, camera.cy_px}));
  EXPECT_FALSE(camera.Unproject({camera.cx_px + 0.862 * camera.fx_px, camera.cy_px}));
  EXPECT_FALSE(camera.Unproject({NAN, 0}));
}

TEST(IsInFront, EndsWhereTheDistortedRadiusStopsGrowing) {
  CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  camera.distortion = {-0.2};
  const double limit = std::sqrt(1 / 0.6);
  EXPECT_TRUE(camera.IsInFront({limit - 1e-9, 0, 1}));
  EXPECT_FALSE(camera.IsInFront({limit + 1e-9, 0, 1}));
  EXPECT_FALSE(camera.IsInFront({10, 0, 1}));
}

TEST(IsInFront, NeedsAPointAhead) {
  for (const LensModel lens : test::kLenses) {
    const CameraModel camera = test::SmallCamera(lens);
    EXPECT_TRUE(camera.IsInFront({0, 0, 1}));
    EXPECT_FALSE(camera.IsInFront({0, 0, 0}));
    EXPECT_FALSE(camera.IsInFront({0, 0, -1}));
    EXPECT_FALSE(camera.IsInFront({NAN, 0, 1}));
  }
}

TEST(IsInFront, SeesBesideAndBehindThroughAFisheye) {
  CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  camera.distortion = {};
  for (const double theta_rad : {1.5, M_PI / 2, 1.7, 2.5, 3.1}) {
    const Eigen::Vector3d ray(std::sin(theta_rad), 0, std::cos(theta_rad));
    ASSERT_TRUE(camera.IsInFront(2.0 * ray)) << theta_rad;
    EXPECT_TRUE(camera.IsProjectable(2.0 * ray)) << theta_rad;
    const Eigen::Vector2d pixel_px = camera.Project(Eigen::Vector3d(2.0 * ray));
    EXPECT_NEAR(pixel_px.x(), camera.cx_px + camera.fx_px * theta_rad, 1e-9);
    const auto back = camera.Unproject(pixel_px);
    ASSERT_TRUE(back) << theta_rad;
    EXPECT_LT((*back - ray).norm(), 1e-12) << theta_rad;
  }
  EXPECT_FALSE(camera.IsProjectable({0, 0, -1}));
  EXPECT_FALSE(test::SmallCamera(LensModel::kPlumbBob).IsProjectable({1, 0, 0}));
}

TEST(IsInFront, SeesAlmostNinetyDegreesWithoutDistortion) {
  CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  camera.distortion = {};
  EXPECT_TRUE(camera.IsInFront({1, 0, 1e-6}));
}

TEST(Contains, TakesThePixelsWholeArea) {
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  EXPECT_TRUE(camera.Contains({-0.5, -0.5}));
  EXPECT_TRUE(camera.Contains({639.4, 399.4}));
  EXPECT_FALSE(camera.Contains({-0.6, 0}));
  EXPECT_FALSE(camera.Contains({639.5, 0}));
  EXPECT_FALSE(camera.Contains({NAN, 0}));
}

TEST(CameraModelProblems, NamesEachBrokenRuleWithItsValue) {
  EXPECT_TRUE(test::RealCamera().Problems().empty());
  CameraModel camera = test::RealCamera();
  camera.width_px = -3;
  camera.fx_px = NAN;
  camera.distortion[5] = 0.25;
  EXPECT_THAT(camera.Problems(),
              testing::ElementsAre("width_px must be positive, is -3",
                                   "fx_px must be positive and finite, is nan",
                                   "distortion[5] must be zero, as equidistant has 4 coefficients, "
                                   "is 0.25"));
}

TEST(LensModelFromString, TakesOurNamesAndRos) {
  for (const LensModel lens : test::kLenses) EXPECT_EQ(LensModelFromString(ToString(lens)), lens);
  EXPECT_EQ(LensModelFromString("fisheye"), LensModel::kEquidistant);
  EXPECT_EQ(LensModelFromString("rational_polynomial"), LensModel::kRational);
  EXPECT_FALSE(LensModelFromString("pinhole"));
}

}  // namespace
}  // namespace voqcal
