#include "core/problems.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ProblemList, HasALineForEachBrokenRuleWithTheValue) {
  ProblemList problems;
  problems.Require(false, "rate_hz must be at most 10", 12.5);
  problems.Require(true, "port must be 0 to 65535", 80);
  problems.RequirePositive("gain", -1);
  EXPECT_THAT(problems.lines(),
              ElementsAre("rate_hz must be at most 10, is 12.5", "gain must be positive, is -1"));
}

TEST(ProblemList, TakesNoNanForPositive) {
  ProblemList problems;
  problems.RequirePositive("gain", std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(problems.lines(), ElementsAre("gain must be positive, is nan"));
}

TEST(ProblemList, PutsThePartBeforeItsProblems) {
  ProblemList problems;
  problems.Add({"blur must be positive, is 0", "spill must be positive, is 0"}, "beam: ");
  EXPECT_THAT(
      problems.lines(),
      ElementsAre("beam: blur must be positive, is 0", "beam: spill must be positive, is 0"));
}

TEST(ProblemList, IsEmptyUntilARuleIsBroken) {
  ProblemList problems;
  problems.Require(true, "port must be 0 to 65535", 80);
  problems.Add({});
  EXPECT_TRUE(problems.empty());
  EXPECT_THAT(problems.lines(), IsEmpty());
}

TEST(RequireUsable, ThrowsAllProblemsInOneSentence) {
  EXPECT_NO_THROW(RequireUsable("Options", {}));
  try {
    RequireUsable("Options", {"a must be positive, is 0", "b must be positive, is 0"});
    FAIL() << "must throw";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "Options: a must be positive, is 0; b must be positive, is 0");
  }
}

}  // namespace
}  // namespace voqcal
