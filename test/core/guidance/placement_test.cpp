#include "core/guidance/placement.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/rigid.hpp"
#include "core/units.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Eigen::Vector3d Up() { return test::TestExtrinsic().linear().col(2); }

Placement InTheMiddle(double distance_m) {
  Placement placement;
  placement.centre_px = {960, 604};
  placement.distance_m = distance_m;
  return placement;
}

bool IsSeen(const Placement& placement) {
  const auto pose = PoseOf(placement, test::TestCamera(), Up());
  return pose &&
         IsInView(*pose, test::TestExtrinsic(), test::TestBoard(), test::TestCamera(), {}, {});
}

TEST(PoseOf, IsWhatPlacementOfReads) {
  Placement placement = InTheMiddle(2.5);
  placement.centre_px = {1300, 500};
  placement.yaw_rad = 25 * kRadPerDeg;
  placement.pitch_rad = -35 * kRadPerDeg;
  placement.turn_rad = 60 * kRadPerDeg;
  const auto pose = PoseOf(placement, test::TestCamera(), Up());
  ASSERT_TRUE(pose);
  const Placement read = PlacementOf(*pose, test::TestCamera(), Up());
  EXPECT_LT((read.centre_px - placement.centre_px).norm(), 1e-6);
  EXPECT_NEAR(read.distance_m, placement.distance_m, 1e-12);
  EXPECT_NEAR(read.yaw_rad, placement.yaw_rad, 1e-12);
  EXPECT_NEAR(read.pitch_rad, placement.pitch_rad, 1e-12);
  EXPECT_NEAR(read.turn_rad, placement.turn_rad, 1e-12);
}

TEST(PoseOf, HoldsADiamondThatFacesTheCamera) {
  const auto pose = PoseOf(InTheMiddle(2.0), test::TestCamera(), Up());
  ASSERT_TRUE(pose);
  const Eigen::Vector3d to_camera = -pose->translation();
  EXPECT_LT(AngleBetween(pose->linear().col(2), to_camera), 1e-9);
  EXPECT_NEAR(pose->linear().col(0).dot(Up()), std::sqrt(0.5), 0.01);  // up is 2 degrees off across
  EXPECT_NEAR(pose->linear().col(1).dot(Up()), std::sqrt(0.5), 0.01);
}

TEST(PoseOf, TurnsTheSidesThatItNames) {
  Placement placement = InTheMiddle(2.0);
  placement.pitch_rad = 30 * kRadPerDeg;
  auto pose = PoseOf(placement, test::TestCamera(), Up());
  ASSERT_TRUE(pose);
  // The diamond's uppermost corner is the board's (+, +).
  EXPECT_LT((*pose * Eigen::Vector3d(0.3, 0.4, 0)).norm(), pose->translation().norm());
  placement.pitch_rad = 0.0;
  placement.yaw_rad = 30 * kRadPerDeg;
  pose = PoseOf(placement, test::TestCamera(), Up());
  ASSERT_TRUE(pose);
  // Its leftmost is (-, +).
  const Eigen::Vector3d left_m = *pose * Eigen::Vector3d(-0.3, 0.4, 0);
  EXPECT_LT(left_m.x(), pose->translation().x());
  EXPECT_LT(left_m.norm(), pose->translation().norm());
}

TEST(PoseOf, IsNothingWhereUpIsAlongTheRay) {
  const auto pose = [](double angle_deg) {
    const auto ray = test::TestCamera().Unproject(InTheMiddle(2.0).centre_px);
    const Eigen::Vector3d across = ray->unitOrthogonal();
    const double angle_rad = angle_deg * kRadPerDeg;
    const Eigen::Vector3d up =
        std::cos(angle_rad) * ray->normalized() + std::sin(angle_rad) * across;
    return PoseOf(InTheMiddle(2.0), test::TestCamera(), up);
  };
  EXPECT_FALSE(pose(0));
  EXPECT_FALSE(pose(9));
  EXPECT_TRUE(pose(11));
  EXPECT_TRUE(pose(169));
  EXPECT_FALSE(pose(171));
}

TEST(IsInView, OfAWholeBoardOnly) {
  EXPECT_TRUE(IsSeen(InTheMiddle(2.5)));  // nearer, the lidar sees only a part
  Placement placement = InTheMiddle(2.5);
  placement.centre_px.x() = 100;  // cut off by the image's border
  EXPECT_FALSE(IsSeen(placement));
  placement = InTheMiddle(3.0);
  placement.centre_px.y() = 250;  // 17 degrees above the axis: over the lidar's highest row
  EXPECT_FALSE(IsSeen(placement));
}

TEST(IsInView, WithinReachAndNotTooSlanted) {
  EXPECT_FALSE(IsSeen(InTheMiddle(1.0)));
  EXPECT_FALSE(IsSeen(InTheMiddle(5.5)));
  Placement placement = InTheMiddle(2.5);
  placement.yaw_rad = 30 * kRadPerDeg;
  EXPECT_TRUE(IsSeen(placement));
  placement.yaw_rad = 45 * kRadPerDeg;
  EXPECT_FALSE(IsSeen(placement));
}

TEST(IsInView, OfSquaresThatTheDetectorFinds) {
  PlacementLimits limits;
  limits.max_distance_m = 20.0;
  limits.min_square_px = 30.0;  // squares of 95 mm and 1177 px a radian: up to 3.7 m
  for (const auto& [distance_m, is_seen] : {std::pair{3.5, true}, std::pair{3.9, false}}) {
    const auto pose = PoseOf(InTheMiddle(distance_m), test::TestCamera(), Up());
    EXPECT_EQ(
        IsInView(*pose, test::TestExtrinsic(), test::TestBoard(), test::TestCamera(), {}, limits),
        is_seen);
  }
}

TEST(IsInView, WithinTheLidarsAzimuths) {
  SensorExpectation narrow;
  narrow.max_azimuth_rad = 20 * kRadPerDeg;
  const auto seen = [&](double column_px) {
    Placement placement = InTheMiddle(3.0);
    placement.centre_px.x() = column_px;
    const auto pose = PoseOf(placement, test::TestCamera(), Up());
    return IsInView(
        *pose, test::TestExtrinsic(), test::TestBoard(), test::TestCamera(), narrow, {});
  };
  EXPECT_TRUE(seen(960));
  EXPECT_FALSE(seen(1500));  // 27 degrees to the right
}

TEST(PlacementLimits, NamesEachProblem) {
  EXPECT_THAT(PlacementLimits{}.Problems(), ElementsAre());
  PlacementLimits bad;
  bad.min_distance_m = 3.0;
  bad.max_distance_m = 2.0;
  bad.max_incidence_rad = 2.0;
  bad.image_margin = 0.5;
  bad.min_square_px = -1.0;
  bad.min_rows = -1;
  EXPECT_THAT(bad.Problems(),
              ElementsAre("max_distance_m must be at least min_distance_m, is 2",
                          HasSubstr("max_incidence_deg must be within 0 and 90, is 114"),
                          "image_margin must be within 0 and 0.5, is 0.5",
                          "min_square_px must not be negative, is -1",
                          "min_rows must not be negative, is -1"));
}

}  // namespace
}  // namespace voqcal
