#include "images/png.hpp"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <png.h>
#include <sys/resource.h>

#include "modules/images/encoded_files.hpp"

namespace voqcal {
namespace {

using test::DecodedByOpenCv;
using test::PngFile;
using test::PngForm;

using Bytes = std::vector<std::uint8_t>;

std::string CauseOf(const Bytes& png) {
  try {
    DecodePng(png);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

class PngOfForm : public testing::TestWithParam<PngForm> {};

TEST_P(PngOfForm, IsDecodedAsByOpenCv) {
  for (const cv::Size& size : {cv::Size(64, 48), cv::Size(61, 39), cv::Size(1, 1)}) {
    const Bytes png = PngFile(size.width, size.height, GetParam());
    const cv::Mat ours = DecodePng(png);
    const cv::Mat theirs = DecodedByOpenCv(png, cv::IMREAD_ANYCOLOR);
    ASSERT_EQ(ours.size(), theirs.size());
    ASSERT_EQ(ours.type(), theirs.type());
    EXPECT_EQ(cv::norm(ours, theirs, cv::NORM_INF), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    DecodePng,
    PngOfForm,
    testing::Values(PngForm{"Grey", PNG_COLOR_TYPE_GRAY},
                    PngForm{"Grey1", PNG_COLOR_TYPE_GRAY, 1},
                    PngForm{"Grey4", PNG_COLOR_TYPE_GRAY, 4},
                    PngForm{"Grey16", PNG_COLOR_TYPE_GRAY, 16},
                    PngForm{"GreyInterlaced", PNG_COLOR_TYPE_GRAY, 8, true},
                    PngForm{"GreyOneTransparent", PNG_COLOR_TYPE_GRAY, 8, false, true},
                    PngForm{"GreyLinear", PNG_COLOR_TYPE_GRAY, 8, false, false, 1.0},
                    PngForm{"Grey16Linear", PNG_COLOR_TYPE_GRAY, 16, false, false, 1.0},
                    PngForm{"GreyAlpha", PNG_COLOR_TYPE_GRAY_ALPHA},
                    PngForm{"GreyAlpha16", PNG_COLOR_TYPE_GRAY_ALPHA, 16},
                    PngForm{"Rgb", PNG_COLOR_TYPE_RGB},
                    PngForm{"Rgb16", PNG_COLOR_TYPE_RGB, 16},
                    PngForm{"RgbInterlaced", PNG_COLOR_TYPE_RGB, 8, true},
                    PngForm{"RgbOneTransparent", PNG_COLOR_TYPE_RGB, 8, false, true},
                    PngForm{"Rgba", PNG_COLOR_TYPE_RGB_ALPHA},
                    PngForm{"Rgba16", PNG_COLOR_TYPE_RGB_ALPHA, 16},
                    PngForm{"Palette", PNG_COLOR_TYPE_PALETTE},
                    PngForm{"Palette4", PNG_COLOR_TYPE_PALETTE, 4},
                    PngForm{"Palette1", PNG_COLOR_TYPE_PALETTE, 1},
                    PngForm{"PaletteTransparent", PNG_COLOR_TYPE_PALETTE, 8, true, true}),
    [](const auto& tested) { return tested.param.name; });

// What is an image to OpenCV is the same one here, or both refuse it.
TEST(DecodePng, TakesDamageAsOpenCvDoes) {
  const Bytes whole = PngFile(8, 6, {"", PNG_COLOR_TYPE_PALETTE, 8, false, true, 1.0});
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(CauseOf(cut), "none") << i;
    Bytes damaged = whole;
    damaged[i] ^= 0x55;
    const cv::Mat theirs = DecodedByOpenCv(damaged, cv::IMREAD_ANYCOLOR);
    ASSERT_EQ(CauseOf(damaged) == "none", !theirs.empty()) << i << ": " << CauseOf(damaged);
    if (theirs.empty()) continue;
    EXPECT_EQ(cv::norm(DecodePng(damaged), theirs, cv::NORM_INF), 0) << i;
  }
}

// ISO/IEC 15948: a chunk is the length of its data, 4 bytes; its type, 4; the data; a CRC, 4.
// libpng on its own unpacks and keeps a thousand texts of up to 8 MB.
TEST(DecodePng, KeepsNoTexts) {
  constexpr std::size_t kTextBytes = 7000000;
  constexpr int kNumTexts = 20;
  const Bytes type = {'z', 'T', 'X', 't'};
  const Bytes with_text = PngFile(8, 6, {"", PNG_COLOR_TYPE_GRAY, 8, false, false, 0, kTextBytes});
  const auto at = std::search(with_text.begin(), with_text.end(), type.begin(), type.end());
  ASSERT_NE(at, with_text.end());
  const Bytes chunk(at - 4, at + 8 + at[-2] * 256 + at[-1]);
  Bytes png(with_text.begin(), at - 4);
  for (int i = 0; i < kNumTexts; ++i) png.insert(png.end(), chunk.begin(), chunk.end());
  png.insert(png.end(), at - 4, with_text.end());
  const auto peak_kb = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const auto before_kb = peak_kb();
  EXPECT_EQ(DecodePng(png).size(), cv::Size(8, 6));
  // Unpacked they are 140 MB.
  EXPECT_LT(peak_kb() - before_kb, 20000);
}

TEST(DecodePng, RefusesASizeThatNoCameraHas) {
  Bytes png = PngFile(1, 1, {"", PNG_COLOR_TYPE_GRAY});
  constexpr std::size_t kHeaderAt = 12;  // chunk IHDR: its type, then width, height, 5 bytes, CRC
  for (const std::size_t at : {4U, 8U}) png[kHeaderAt + at + 2] = 0x7D;
  const png_uint_32 crc = [&png] {
    png_uint_32 remainder = 0xFFFFFFFFU;  // ISO/IEC 15948, Annex D
    for (std::size_t i = kHeaderAt; i < kHeaderAt + 17; ++i) {
      remainder ^= png[i];
      for (int bit = 0; bit < 8; ++bit) {
        remainder = (remainder & 1U) != 0 ? 0xEDB88320U ^ (remainder >> 1U) : remainder >> 1U;
      }
    }
    return ~remainder;
  }();
  for (unsigned i = 0; i < 4; ++i) {
    png[kHeaderAt + 17 + i] = static_cast<std::uint8_t>(crc >> (24U - 8U * i));
  }
  EXPECT_EQ(CauseOf(png), "32001 x 32001 px are too many");
}

}  // namespace
}  // namespace voqcal
