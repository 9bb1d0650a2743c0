#include "study/statistics.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(SpearmanCorrelation, KnowsOrderOnly) {
  EXPECT_DOUBLE_EQ(SpearmanCorrelation({1, 2, 3, 4}, {-5, 0, 1, 1e9}), 1.0);
  EXPECT_DOUBLE_EQ(SpearmanCorrelation({1, 2, 3, 4}, {4, 3, 2, 1}), -1.0);
}

TEST(SpearmanCorrelation, AgreesWithTheFormulaOfDifferences) {
  // Without ties: 1 - 6 sum d^2 / (n (n^2 - 1)). Ranks of y: 2 1 4 3 5, so sum d^2 = 4.
  EXPECT_NEAR(SpearmanCorrelation({1, 2, 3, 4, 5}, {20, 10, 40, 30, 50}), 1 - 24.0 / 120, 1e-12);
}

TEST(SpearmanCorrelation, SharesTheRanksOfTies) {
  // Ranks of x: 0.5 0.5 2; of y: 0 1 2. Covariance 1.5, variances 1.5 and 2 (sums).
  EXPECT_NEAR(SpearmanCorrelation({7, 7, 9}, {1, 2, 3}), 1.5 / std::sqrt(1.5 * 2), 1e-12);
}

TEST(SpearmanCorrelation, IsUnknownForAConstant) {
  EXPECT_TRUE(std::isnan(SpearmanCorrelation({1, 1, 1}, {1, 2, 3})));
  EXPECT_TRUE(std::isnan(SpearmanCorrelation({}, {})));
}

TEST(EqualCountBins, CutsTheAscendingOrder) {
  EXPECT_THAT(EqualCountBins({5, 1, 4, 2, 3}, 2),
              ElementsAre(ElementsAre(1, 3), ElementsAre(4, 2, 0)));
  EXPECT_THAT(EqualCountBins({2, 1}, 5), ElementsAre(ElementsAre(1), ElementsAre(0)));
  EXPECT_THAT(EqualCountBins({}, 5), IsEmpty());
}

TEST(Statistics, OfFewValues) {
  EXPECT_EQ(Mean({1, 2, 6}), 3.0);
  EXPECT_EQ(Largest({1, 6, 2}), 6.0);
  EXPECT_DOUBLE_EQ(StandardDeviation({1, 2, 6}), std::sqrt(7.0));
  EXPECT_TRUE(std::isnan(Mean({})) && std::isnan(Largest({})));
  EXPECT_TRUE(std::isnan(StandardDeviation({1})));
}

}  // namespace
}  // namespace voqcal
