#include "result/extrinsic_text.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::HasSubstr;

ExportedExtrinsic WithLens(LensModel lens) {
  ExportedExtrinsic extrinsic;
  extrinsic.camera.emplace();
  extrinsic.camera->lens = lens;
  return extrinsic;
}

TEST(FormatProblem, OnlyMrcalNeedsALensAndNotAFisheye) {
  for (const std::string& format : ExportFormats()) {
    const bool is_mrcal = format == "mrcal";
    EXPECT_EQ(FormatProblem(format, {}).empty(), !is_mrcal) << format;
    EXPECT_EQ(FormatProblem(format, WithLens(LensModel::kEquidistant)).empty(), !is_mrcal);
    EXPECT_EQ(FormatProblem(format, WithLens(LensModel::kPlumbBob)), "");
  }
}

TEST(ExtrinsicText, RefusesWhatTheFormatCannotCarry) {
  try {
    ExtrinsicText("mrcal", WithLens(LensModel::kEquidistant));
    FAIL() << "a fisheye in mrcal's format";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("no lens model for an equidistant"));
  }
}

}  // namespace
}  // namespace voqcal
