#include "core/likelihood/lidar_bias.hpp"

#include <gtest/gtest.h>

namespace voqcal {
namespace {

LidarBias BiasOfShadesAndRings() {
  LidarBias bias;
  bias.common.value_m = 0.01;
  bias.dark_step.value_m = 0.02;
  bias.shades = ShadeScaleOf({0.0F, 0.0F, 100.0F, 100.0F});
  bias.rings.resize(1);
  bias.rings[0].value_m = 0.04;
  return bias;
}

/// How far the correction moves one point at 5 m.
double MoveM(bool has_intensity, bool has_ring) {
  PointCloud cloud;
  cloud.has_intensity = has_intensity;
  cloud.has_ring = has_ring;
  LidarPoint point;
  point.position_m = {5.0F, 0.0F, 0.0F};
  cloud.points = {point};
  return 5.0 -
         static_cast<double>(BiasOfShadesAndRings().Corrected(cloud).points[0].position_m.x());
}

// The points of a cloud without intensities or rings have zeros there, which say nothing.
TEST(LidarBias, CorrectsByShadeAndRingOnlyWhereTheCloudHasThem) {
  constexpr double kFloatM = 1e-6;  // of a range of 5 m
  const double shade = BiasOfShadesAndRings().shades.ShadeOf(0.0F);
  ASSERT_NE(shade, 0.0);
  EXPECT_NEAR(MoveM(false, false), 0.01, kFloatM);
  EXPECT_NEAR(MoveM(false, true), 0.01 + 0.04, kFloatM);
  EXPECT_NEAR(MoveM(true, false), 0.01 + 0.02 * shade, kFloatM);
  EXPECT_NEAR(MoveM(true, true), 0.01 + 0.02 * shade + 0.04, kFloatM);
}

}  // namespace
}  // namespace voqcal
