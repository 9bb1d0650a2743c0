#include "core/camera/named_lens.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::HasSubstr;

using Coefficients = std::array<double, 8>;

void ExpectLens(const std::string& model,
                const std::vector<double>& given,
                LensModel lens,
                const Coefficients& distortion) {
  const auto named = LensByName(model, given);
  ASSERT_TRUE(named) << model << ": " << named.error().rule;
  EXPECT_EQ(named->lens, lens) << model;
  EXPECT_EQ(named->distortion, distortion) << model;
}

TEST(LensByName, TakesTheNamesOfRosOpenCvAndKalibr) {
  for (const char* model :
       {"plumb_bob", "radtan", "Radial-Tangential", "brown_conrady", "pinhole"}) {
    ExpectLens(model, {1, 2, 3, 4}, LensModel::kPlumbBob, {1, 2, 3, 4});
    ExpectLens(model, {1, 2, 3, 4, 5}, LensModel::kPlumbBob, {1, 2, 3, 4, 5});
  }
  for (const char* model : {"equidistant", "fisheye", "kannala_brandt", "pinhole-equi"}) {
    ExpectLens(model, {1, 2, 3, 4}, LensModel::kEquidistant, {1, 2, 3, 4});
  }
  ExpectLens("pinhole", {}, LensModel::kPlumbBob, {});
  ExpectLens("rational_polynomial",
             {1, 2, 3, 4, 5, 6, 7, 8},
             LensModel::kRational,
             {1, 2, 3, 4, 5, 6, 7, 8});
}

TEST(LensByName, TakesFurtherCoefficientsOfOpenCvWhereTheyAreZero) {
  for (const std::size_t num : {8U, 12U, 14U}) {
    std::vector<double> given = {1, 2, 3, 4, 5};
    given.resize(num);
    ExpectLens("plumb_bob", given, LensModel::kPlumbBob, {1, 2, 3, 4, 5});
    given[7] = 8;  // a rational lens that is called plumb_bob
    ExpectLens("plumb_bob", given, LensModel::kRational, {1, 2, 3, 4, 5, 0, 0, 8});
  }
}

TEST(LensByName, RefusesAThinPrismWithWhatToDo) {
  std::vector<double> given(12);
  given[8] = 1e-3;
  const auto named = LensByName("plumb_bob", given);
  ASSERT_FALSE(named);
  EXPECT_TRUE(named.error().is_of_coefficients);
  EXPECT_THAT(named.error().rule, HasSubstr("calibrate the camera without CALIB_THIN_PRISM_MODEL"));
}

TEST(LensByName, RefusesOtherLensesWithHowToConvert) {
  const auto named = LensByName("eucm", {1, 2});
  ASSERT_FALSE(named);
  EXPECT_FALSE(named.error().is_of_coefficients);
  EXPECT_THAT(named.error().rule, HasSubstr("Kalibr by --models pinhole-radtan or pinhole-equi"));
}

TEST(LensByName, RefusesAWrongNumberOfCoefficients) {
  for (const std::size_t num : {0U, 3U, 6U, 13U, 15U}) {
    EXPECT_FALSE(LensByName("plumb_bob", std::vector<double>(num))) << num;
  }
  EXPECT_FALSE(LensByName("equidistant", {0.1, 0.2, 0.3}));
  EXPECT_FALSE(LensByName("equidistant", {0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_TRUE(LensByName("equidistant", {0.1, 0.2, 0.3, 0.4, 0.0}));  // cam_lidar_calibration's
  EXPECT_FALSE(LensByName("rational", std::vector<double>(5)));
}

}  // namespace
}  // namespace voqcal
