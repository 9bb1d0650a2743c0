#include "result/join_rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

PairSession SessionOfTwo() {
  PairSession session;
  session.lidar = "front";
  session.camera = "left";
  return session;
}

CalibrationResult WithCovariance(const Matrix6d& covariance) {
  CalibrationResult result;
  result.covariance_given_rig = covariance;
  return result;
}

TEST(TakeResult, WhatIsNotDefiniteIsAProblemOfThePairAndNoErrorOfTheRig) {
  PairSession session = SessionOfTwo();
  TakeResult({}, WithCovariance(Matrix6d::Identity()), "", &session);
  EXPECT_THAT(session.pair.problem, IsEmpty());
  EXPECT_TRUE(JoinSessions({session}, "", {}).network.IsUsable());

  Matrix6d open = Matrix6d::Identity();
  open(5, 5) = -1e-12;  // a direction that the poses leave open, to the last digit
  TakeResult({}, WithCovariance(open), "", &session);
  EXPECT_THAT(session.pair.problem, HasSubstr("too alike, to tell how certain it is"));
  EXPECT_THAT(JoinSessions({session}, "", {}).network.problem, HasSubstr("front | left"));
}

}  // namespace
}  // namespace voqcal
