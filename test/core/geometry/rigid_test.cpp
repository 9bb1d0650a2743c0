#include "core/geometry/rigid.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

// Rounding of a few dozen operations on numbers of order one.
constexpr double kRounding = 1e-14;

TEST(Skew, MultipliesAsTheCrossProduct) {
  const Eigen::Vector3d a(1, -2, 3);
  const Eigen::Vector3d b(-4, 0.5, 2);
  EXPECT_TRUE((Skew(a) * b).isApprox(a.cross(b), kRounding));
}

TEST(ExpSO3, AgreesWithTheSeries) {
  const Eigen::Vector3d omega(0.3, -0.2, 0.1);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  for (int k = 1; k < 20; ++k) {
    term = term * Skew(omega) / k;
    sum += term;
  }
  EXPECT_TRUE(ExpSO3(omega).isApprox(sum, kRounding));
}

TEST(LogSO3, InvertsExpFromZeroToPi) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3;
  for (const double angle : {0.0, 1e-15, 1e-9, 1e-4, 0.5, 2.0, 3.1, M_PI - 1e-7}) {
    EXPECT_LT((LogSO3(ExpSO3(angle * axis)) - angle * axis).norm(), kRounding) << angle;
  }
}

TEST(NearestRotation, IsARotationAndKeepsRotations) {
  const Eigen::Matrix3d R = ExpSO3({0.4, 1.1, -0.6});
  EXPECT_TRUE(NearestRotation(3.0 * R).isApprox(R, kRounding));
  const Eigen::Matrix3d nearest = NearestRotation(-R);
  EXPECT_NEAR(nearest.determinant(), 1.0, kRounding);
  EXPECT_TRUE((nearest * nearest.transpose()).isIdentity(kRounding));
}

TEST(DifferenceLeft, InvertsPerturbLeft) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({1, 0.2, 0.1});
  T.translation() << 3, 4, 5;
  Vector6d delta;
  delta << 0.1, -0.2, 0.05, 1, 2, -3;
  EXPECT_LT((DifferenceLeft(T, PerturbLeft(T, delta)) - delta).norm(), 10 * kRounding);
}

TEST(AngleBetween, IsExactNearZeroAndPi) {
  const Eigen::Vector3d a(2, 0, 0);
  EXPECT_NEAR(AngleBetween(a, {1, 1e-9, 0}), 1e-9, 1e-20);
  EXPECT_NEAR(M_PI - AngleBetween(a, {-1, 1e-9, 0}), 1e-9, 1e-15);
}

TEST(RotationAngleBetween, IsTheAngleOfTheDifference) {
  const Eigen::Matrix3d R = ExpSO3({0.4, 1.1, -0.6});
  EXPECT_NEAR(RotationAngleBetween(R, ExpSO3({0, 0.3, 0}) * R), 0.3, kRounding);
}

TEST(MeanRotation, IsTheMiddleOfATurn) {
  const Eigen::Matrix3d R = ExpSO3({0.4, 1.1, -0.6});
  const Eigen::Vector3d turn(0, 0, 0.5);
  EXPECT_TRUE(MeanRotation({ExpSO3(turn) * R, ExpSO3(-turn) * R}).isApprox(R, kRounding));
}

TEST(MeanRotation, RefusesNoRotations) { EXPECT_THROW(MeanRotation({}), std::invalid_argument); }

}  // namespace
}  // namespace voqcal
