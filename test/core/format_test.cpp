#include "core/format.hpp"

#include <gtest/gtest.h>

namespace voqcal {
namespace {

TEST(Format, PrintsAsPrintfDoes) {
  EXPECT_EQ(Format("%s is %.2f of %d %%", "share", 0.125, 8), "share is 0.12 of 8 %");
  EXPECT_EQ(Format("%s", ""), "");
}

TEST(Format, KeepsTextsOfAnyLength) {
  const std::string name(5000, 'x');
  EXPECT_EQ(Format("<%s>", name.c_str()), "<" + name + ">");
}

}  // namespace
}  // namespace voqcal
