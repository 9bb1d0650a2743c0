#include "core/assessment/enough.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

WorstError Worst(double error_mm) {
  WorstError worst;
  worst.error = error_mm;
  worst.range_m = 5.0;
  return worst;
}

TEST(JudgeEnough, AsksForPosesAndForThePredictedError) {
  const EnoughOptions options;  // 5 mm out to 5 m, 8 samples
  const Enough enough = JudgeEnough(8, Worst(4.2461), options);
  EXPECT_TRUE(enough.is_enough);
  EXPECT_EQ(enough.words, "Enough: 4.2 mm at worst, at 5 m; 5 mm are asked.");
  const Enough few = JudgeEnough(7, Worst(4.2461), options);
  EXPECT_FALSE(few.is_enough);
  EXPECT_EQ(few.words, "Fewer than 8 are not enough, however certain they seem.");
  const Enough unsure = JudgeEnough(30, Worst(5.01), options);
  EXPECT_FALSE(unsure.is_enough);
  EXPECT_EQ(unsure.words, "Not enough yet: 5.1 mm at worst, at 5 m; 5 mm are asked.");
}

TEST(JudgeEnough, IsNeverEnoughWhereNothingIsKnown) {
  EXPECT_FALSE(JudgeEnough(30, Worst(std::numeric_limits<double>::quiet_NaN()), {}).is_enough);
  EXPECT_FALSE(JudgeEnough(30, Worst(std::numeric_limits<double>::infinity()), {}).is_enough);
}

}  // namespace
}  // namespace voqcal
