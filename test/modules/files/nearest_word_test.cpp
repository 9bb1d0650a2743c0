#include "files/nearest_word.hpp"

#include <gtest/gtest.h>

namespace voqcal {
namespace {

TEST(NearestWord, IsTheOneWithTheFewestSlips) {
  const std::set<std::string> words = {"width_m", "height_m", "square_m", "num_corners_x"};
  EXPECT_EQ(NearestWord("heigth_m", words), "height_m");           // swapped
  EXPECT_EQ(NearestWord("num_corner_x", words), "num_corners_x");  // missing
  EXPECT_EQ(NearestWord("width_mm", words), "width_m");            // added
  EXPECT_EQ(NearestWord("sqaure-m", words), "square_m");           // swapped and changed
  EXPECT_EQ(NearestWord("width_m", words), "width_m");
}

TEST(NearestWord, IsNoneWhereNoneIsNear) {
  EXPECT_EQ(NearestWord("colour", {"width_m", "height_m"}), "");
  EXPECT_EQ(NearestWord("x", {"fx", "cy_px"}), "fx");  // one slip is always allowed
  EXPECT_EQ(NearestWord("x", {"fx2"}), "");
  EXPECT_EQ(NearestWord("x", {}), "");
}

}  // namespace
}  // namespace voqcal
