#include "core/board/board_sample.hpp"

#include <gtest/gtest.h>

#include "support/matchers.hpp"

namespace voqcal {
namespace {

const BoardSpec kBoard{0.61, 0.85, 0.095, 5, 7, 0, 0};

Eigen::Isometry3d SomePose() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({2.8, 0.4, -0.3});
  T.translation() << 0.2, -0.1, 2.5;
  return T;
}

TEST(TransformFromPose, InvertsPoseFromTransform) {
  // Rounding of coordinates of order one.
  EXPECT_THAT(TransformFromPose(PoseFromTransform(SomePose(), kBoard)),
              test::IsNear(SomePose(), 1e-14, 1e-14));
}

TEST(TurnedByHalf, TurnsTheAxesAboutTheNormal) {
  const Eigen::Isometry3d half_turn(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  EXPECT_THAT(TransformFromPose(TurnedByHalf(PoseFromTransform(SomePose(), kBoard))),
              test::IsNear(SomePose() * half_turn, 1e-14, 1e-14));
}

}  // namespace
}  // namespace voqcal
