#include "core/estimation/combine.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

UncertainExtrinsic Estimate(const Vector6d& delta, double sigma) {
  return {PerturbLeft(Eigen::Isometry3d::Identity(), delta), sigma * sigma * Matrix6d::Identity()};
}

TEST(Combine, GoesToTheSharperWhereTheyAgree) {
  Vector6d away = Vector6d::Zero();
  away[1] = 0.001;  // a tenth of the robust one's sigma
  const CombinedExtrinsic combined =
      Combine(Estimate(Vector6d::Zero(), 0.01), Estimate(away, 0.001));
  const Vector6d gone =
      DifferenceLeft(Eigen::Isometry3d::Identity(), combined.extrinsic.T_camera_lidar);
  EXPECT_NEAR(gone[1], 0.001 / 1.01, 1e-9);  // by the variances, 100 to 1
  // Both saw the same samples: no better known than by the sharp one, to a few percent.
  EXPECT_NEAR(std::sqrt(combined.extrinsic.covariance(1, 1)), 0.001, 0.00005);
}

TEST(Combine, StaysWithTheRobustOneOnlyWhereTheyContradictEachOther) {
  Vector6d away = Vector6d::Zero();
  away[1] = 0.1;    // ten of the robust one's sigma
  away[4] = 0.001;  // a tenth
  const CombinedExtrinsic combined =
      Combine(Estimate(Vector6d::Zero(), 0.01), Estimate(away, 0.001));
  const Vector6d gone =
      DifferenceLeft(Eigen::Isometry3d::Identity(), combined.extrinsic.T_camera_lidar);
  // The sharp one's variance grows by 100 - 0.99 of the robust one's: 0.01 + 99.01.
  EXPECT_NEAR(gone[1], 0.1 / 100.02, 1e-6);
  EXPECT_NEAR(gone[4], 0.001 / 1.01, 1e-6);
}

TEST(Combine, TwoOfOneKindMeetHalfWay) {
  Vector6d away = Vector6d::Zero();
  away[4] = 0.01;
  const CombinedExtrinsic combined =
      Combine(Estimate(Vector6d::Zero(), 0.01), Estimate(away, 0.01));
  const Vector6d gone =
      DifferenceLeft(Eigen::Isometry3d::Identity(), combined.extrinsic.T_camera_lidar);
  EXPECT_NEAR(gone[4], 0.005, 1e-9);
  // Between independent (a half) and the same (one): three quarters of the variance.
  EXPECT_NEAR(combined.extrinsic.covariance(4, 4), 0.75e-4, 1e-9);
}

}  // namespace
}  // namespace voqcal
