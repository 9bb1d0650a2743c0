#include "core/camera/lens_errors.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

// Of equal focal lengths and without distortion, so that shares are exact.
CameraModel PlainCamera(LensModel lens) {
  CameraModel camera = test::SmallCamera(lens);
  camera.fy_px = camera.fx_px;
  camera.distortion = {};
  return camera;
}

// A point that is half the image's width to the right of the middle.
Eigen::Vector3d PointAtReach(const CameraModel& camera) {
  const double q = LensReachPx(camera) / camera.fx_px;
  if (camera.lens == LensModel::kEquidistant) return {std::sin(q), 0.0, std::cos(q)};
  return {q, 0.0, 1.0};
}

TEST(CorrectedCamera, MovesAPointAtHalfTheWidthByTheShare) {
  constexpr double kShare = 0.01;
  for (const LensModel lens : test::kLenses) {
    const CameraModel camera = PlainCamera(lens);
    const Eigen::Vector3d point = PointAtReach(camera);
    for (Eigen::Index i = 0; i < kNumLensErrors; ++i) {
      const Eigen::Vector2d moved_px =
          CorrectedCamera(camera, kShare * LensErrors::Unit(i)).Project(point) -
          camera.Project(point);
      const Eigen::Vector2d direction =
          i == kPrincipalPointY ? Eigen::Vector2d::UnitY() : Eigen::Vector2d::UnitX();
      EXPECT_LT((moved_px - kShare * LensReachPx(camera) * direction).norm(), 1e-9)
          << ToString(lens) << " " << ToString(static_cast<LensError>(i));
    }
  }
}

TEST(CorrectedCamera, IsTheGivenOneWithoutErrors) {
  const CameraModel camera = test::RealCamera();
  const CameraModel corrected = CorrectedCamera(camera, LensErrors::Zero());
  EXPECT_EQ(corrected.fx_px, camera.fx_px);
  EXPECT_EQ(corrected.cy_px, camera.cy_px);
  EXPECT_EQ(corrected.distortion, camera.distortion);
}

}  // namespace
}  // namespace voqcal
