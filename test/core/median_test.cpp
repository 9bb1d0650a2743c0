#include "core/median.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

TEST(Median, IsTheMiddleOrTheMeanOfTheTwoInTheMiddle) {
  EXPECT_EQ(Median({6, 1, 2}), 2.0);
  EXPECT_EQ(Median({6, 1, 2, 4}), 3.0);
  EXPECT_EQ(Median({5}), 5.0);
}

TEST(Median, OfNothingIsNaN) { EXPECT_TRUE(std::isnan(Median({}))); }

}  // namespace
}  // namespace voqcal
