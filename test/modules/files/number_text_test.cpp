#include "files/number_text.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

TEST(NumberText, IsTheShortestThatReadsBackExactly) {
  EXPECT_EQ(NumberText(0.1), "0.1");
  EXPECT_EQ(NumberText(-0.0), "0");
  EXPECT_EQ(NumberText(1.0 / 3), "0.3333333333333333");
  for (const double value : {M_PI, 1e-300, -2.5e17, std::nextafter(1.0, 2.0)}) {
    double read = 0;
    ASSERT_TRUE(ParseNumber(NumberText(value), &read));
    EXPECT_EQ(read, value);
  }
}

TEST(NumberText, WritesWhatIsNoNumberAsYamlDoes) {
  EXPECT_EQ(NumberText(std::numeric_limits<double>::quiet_NaN()), ".nan");
  EXPECT_EQ(NumberText(-std::numeric_limits<double>::infinity()), "-.inf");
}

TEST(ParseNumber, TakesAllOfTheTextOrNothing) {
  double number = 7;
  for (const char* text :
       {"", "+", "-", "1.5x", " 1", "1 ", "1,5", "0x10", "abc", "+-1", "1e999"}) {
    EXPECT_FALSE(ParseNumber(text, &number)) << text;
    EXPECT_EQ(number, 7);
  }
  EXPECT_TRUE(ParseNumber("+1.5e-3", &number));
  EXPECT_EQ(number, 1.5e-3);
}

TEST(ParseNumber, RefusesFractionsAndOverflowInIntegers) {
  int number = 7;
  unsigned int natural = 7;
  EXPECT_FALSE(ParseNumber("1.0", &number));
  EXPECT_FALSE(ParseNumber("3000000000", &number));
  EXPECT_FALSE(ParseNumber("-1", &natural));
  EXPECT_TRUE(ParseNumber("3000000000", &natural));
  EXPECT_EQ(natural, 3000000000U);
  EXPECT_EQ(number, 7);
}

}  // namespace
}  // namespace voqcal
