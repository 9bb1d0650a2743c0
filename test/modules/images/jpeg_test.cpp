#include "images/jpeg.hpp"

#include <algorithm>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "modules/images/encoded_files.hpp"

namespace voqcal {
namespace {

using test::DecodedByOpenCv;
using test::JpegFile;
using test::JpegForm;
using test::Picture;
using testing::HasSubstr;

using Bytes = std::vector<std::uint8_t>;

void ExpectSame(const cv::Mat& ours, const cv::Mat& theirs) {
  ASSERT_EQ(ours.size(), theirs.size());
  ASSERT_EQ(ours.type(), theirs.type());
  EXPECT_EQ(cv::norm(ours, theirs, cv::NORM_INF), 0);
}

std::string CauseOf(const Bytes& jpeg) {
  try {
    DecodeJpeg(jpeg);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

class JpegOfForm : public testing::TestWithParam<JpegForm> {};

// Sizes that are not multiples of the blocks of 8 or 16 pixels, too.
TEST_P(JpegOfForm, IsDecodedAsByOpenCv) {
  for (const cv::Size& size : {cv::Size(64, 48), cv::Size(61, 39), cv::Size(3, 2)}) {
    const Bytes jpeg = JpegFile(size.width, size.height, GetParam());
    ExpectSame(DecodeJpeg(jpeg), DecodedByOpenCv(jpeg, cv::IMREAD_ANYCOLOR));
  }
}

TEST_P(JpegOfForm, IsDecodedInGreyAsByOpenCv) {
  for (const cv::Size& size : {cv::Size(64, 48), cv::Size(61, 39), cv::Size(3, 2)}) {
    const Bytes jpeg = JpegFile(size.width, size.height, GetParam());
    ExpectSame(DecodeJpegInGrey(jpeg), DecodedByOpenCv(jpeg, cv::IMREAD_GRAYSCALE));
  }
}

TEST_P(JpegOfForm, IsMadeSmallerAsByOpenCv) {
  const Bytes jpeg = JpegFile(61, 39, GetParam());
  const bool is_gray = GetParam().num_channels == 1;
  const std::pair<int, int> cases[] = {
      {2, is_gray ? cv::IMREAD_REDUCED_GRAYSCALE_2 : cv::IMREAD_REDUCED_COLOR_2},
      {4, is_gray ? cv::IMREAD_REDUCED_GRAYSCALE_4 : cv::IMREAD_REDUCED_COLOR_4},
      {8, is_gray ? cv::IMREAD_REDUCED_GRAYSCALE_8 : cv::IMREAD_REDUCED_COLOR_8}};
  for (const auto& [reduction, flags] : cases) {
    ExpectSame(DecodeJpeg(jpeg, reduction), DecodedByOpenCv(jpeg, flags));
  }
}

INSTANTIATE_TEST_SUITE_P(DecodeJpeg,
                         JpegOfForm,
                         testing::Values(JpegForm{"Grey", 1},
                                         JpegForm{"GreyProgressive", 1, 1, 1, true},
                                         JpegForm{"Colours444", 3, 1, 1},
                                         JpegForm{"Colours422", 3, 2, 1},
                                         JpegForm{"Colours440", 3, 1, 2},
                                         JpegForm{"Colours420", 3, 2, 2},
                                         JpegForm{"Colours411", 3, 4, 1},
                                         JpegForm{"Colours410", 3, 4, 2},
                                         JpegForm{"Progressive420", 3, 2, 2, true},
                                         JpegForm{"WithoutTables", 3, 2, 1, false, false}),
                         [](const auto& tested) { return tested.param.name; });

// What is an image to OpenCV is the same one here, or both refuse it; but where the data end too
// early OpenCV goes on with grey.
TEST(DecodeJpeg, TakesDamageAsOpenCvDoes) {
  for (const bool is_progressive : {false, true}) {
    const Bytes whole = JpegFile(32, 24, {"", 3, 2, 2, is_progressive});
    for (std::size_t i = 3; i + 2 < whole.size(); ++i) {  // after what OpenCV knows a JPEG by
      Bytes damaged = whole;
      damaged[i] ^= 0x55;
      const cv::Mat theirs = DecodedByOpenCv(damaged, cv::IMREAD_ANYCOLOR);
      const std::string cause = CauseOf(damaged);
      if (cause == "it is cut off") continue;
      ASSERT_EQ(cause == "none", !theirs.empty()) << i << ": " << cause;
      if (!theirs.empty()) ExpectSame(DecodeJpeg(damaged), theirs);
    }
  }
}

TEST(DecodeJpeg, SaysWhatIsWrong) {
  EXPECT_THAT(CauseOf({}), HasSubstr("Empty input file"));
  EXPECT_THAT(CauseOf({'B', 'M', 0, 0}), HasSubstr("Not a JPEG file"));
  EXPECT_THAT(CauseOf(JpegFile(32, 24, {"", 4})), HasSubstr("CMYK"));
  Bytes cut = JpegFile(32, 24, {});
  cut.resize(cut.size() - 20);
  EXPECT_EQ(CauseOf(cut), "it is cut off");
}

TEST(DecodeJpeg, RefusesAnEndMarkerBeforeTheImagesEnd) {
  for (const bool is_progressive : {false, true}) {
    Bytes jpeg = JpegFile(64, 48, {"", 3, 2, 2, is_progressive});
    jpeg.resize(jpeg.size() - 20);
    jpeg.insert(jpeg.end(), {0xFF, 0xD9});
    EXPECT_EQ(CauseOf(jpeg), "it is cut off") << is_progressive;
  }
}

/// A JPEG whose header says that it has 256 times this width and height, and some more.
Bytes WithLargeHeader(int width, int height, bool is_progressive) {
  Bytes jpeg = JpegFile(32, 24, {"", 1, 1, 1, is_progressive});
  const Bytes size = {8, 0, 24, 0, 32};  // of SOF0 or SOF2: bits a sample, height, width
  const auto at = std::search(jpeg.begin(), jpeg.end(), size.begin(), size.end());
  at[1] = static_cast<std::uint8_t>(height);
  at[3] = static_cast<std::uint8_t>(width);
  return jpeg;
}

// All coefficients of a progressive one, two bytes each, come before its first row.
TEST(DecodeJpeg, RefusesASizeThatNoCameraHas) {
  EXPECT_EQ(CauseOf(WithLargeHeader(0x7D, 0x7D, false)), "32032 x 32024 px are too many");
  EXPECT_EQ(CauseOf(WithLargeHeader(0x20, 0x24, true)), "8224 x 9240 px are too many");
  EXPECT_EQ(CauseOf(WithLargeHeader(0x20, 0x24, false)), "it is cut off");
}

// Each scan costs the time of a whole image, and one that refines nothing is some bytes.
TEST(DecodeJpeg, RefusesEndlessScans) {
  Bytes jpeg = JpegFile(32, 24, {"", 1, 1, 1, true});
  const Bytes marker = {0xFF, 0xDA};
  const auto last = std::find_end(jpeg.begin(), jpeg.end(), marker.begin(), marker.end());
  const Bytes scan(last, jpeg.end() - 2);
  Bytes endless(jpeg.begin(), jpeg.end() - 2);
  for (int i = 0; i < 300; ++i) endless.insert(endless.end(), scan.begin(), scan.end());
  endless.insert(endless.end(), {0xFF, 0xD9});
  EXPECT_EQ(CauseOf(endless), "it has too many scans");
}

TEST(EncodeJpeg, GivesTheBytesThatOpenCvGives) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4}) {
    for (const int quality : {1, 72, 95, 100}) {
      const cv::Mat picture = Picture(320, 201, type);  // more than the first buffer holds
      Bytes theirs;
      cv::imencode(".jpg", picture, theirs, {cv::IMWRITE_JPEG_QUALITY, quality});
      EXPECT_EQ(EncodeJpeg(picture, quality), theirs) << type << " at " << quality;
    }
  }
}

TEST(EncodeJpeg, TakesAPartOfAnImage) {
  const cv::Mat part = Picture(64, 48, CV_8UC3)(cv::Rect(5, 7, 30, 20));
  EXPECT_EQ(EncodeJpeg(part, 90), EncodeJpeg(part.clone(), 90));
}

TEST(EncodeJpeg, RefusesOtherImages) {
  EXPECT_THROW(EncodeJpeg(cv::Mat(), 90), std::invalid_argument);
  EXPECT_THROW(EncodeJpeg(cv::Mat(2, 2, CV_16UC1), 90), std::invalid_argument);
  EXPECT_THROW(EncodeJpeg(cv::Mat(2, 2, CV_8UC2), 90), std::invalid_argument);
  EXPECT_THROW(EncodeJpeg(cv::Mat(70000, 1, CV_8UC1, cv::Scalar(9)), 90), std::runtime_error);
}

}  // namespace
}  // namespace voqcal
