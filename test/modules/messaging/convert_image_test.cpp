#include "messaging/convert_image.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "images/encoded_image.hpp"

namespace voqcal {
namespace {

using testing::HasSubstr;

/// Smooth colours that differ in each channel, 40 x 24 px.
cv::Mat Picture() {
  cv::Mat image(24, 40, CV_8UC3);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      image.at<cv::Vec3b>(row, column) = cv::Vec3b(static_cast<std::uint8_t>(5 * column),
                                                   static_cast<std::uint8_t>(9 * row),
                                                   static_cast<std::uint8_t>(3 * row + column));
    }
  }
  return image;
}

cv::Mat GrayPicture() {
  cv::Mat gray;
  cv::extractChannel(Picture(), gray, 1);
  return gray;
}

std::vector<std::uint8_t> Encoded(const cv::Mat& image, const std::string& extension) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

double LargestDifference(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() ? cv::norm(a, b, cv::NORM_INF) : 1e9;
}

std::string CauseOf(const image_t& message) {
  try {
    FromMessage(message);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(ImageMessage, ComesBackExactly) {
  for (const cv::Mat& image : {Picture(), GrayPicture()}) {
    const image_t message = ToMessage(image, 12, 3);
    EXPECT_EQ(message.utime, 12);
    EXPECT_EQ(message.row_stride, 40 * image.channels());
    EXPECT_EQ(LargestDifference(FromMessage(message), image), 0);
  }
}

TEST(ImageMessage, TakesAPartOfAnImage) {
  const cv::Mat part = Picture()(cv::Rect(3, 5, 11, 7));
  EXPECT_EQ(LargestDifference(FromMessage(ToMessage(part, 0, 1)), part), 0);
}

TEST(ImageMessage, RefusesToSendOtherTypes) {
  EXPECT_THROW(ToMessage(cv::Mat(), 0, 1), std::invalid_argument);
  EXPECT_THROW(ToMessage(cv::Mat(2, 2, CV_16UC1), 0, 1), std::invalid_argument);
}

TEST(ImageMessage, ReadsRgbAndPaddedRows) {
  const cv::Mat image = Picture();
  image_t message = ToMessage(image, 0, 1);
  std::vector<std::uint8_t> rgb;
  constexpr int kPadding = 8;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      const cv::Vec3b bgr = image.at<cv::Vec3b>(row, column);
      rgb.insert(rgb.end(), {bgr[2], bgr[1], bgr[0]});
    }
    rgb.resize(rgb.size() + kPadding);
  }
  message.pixelformat = kPixelRgb;
  message.row_stride += kPadding;
  message.size = static_cast<std::int32_t>(rgb.size());
  message.data = rgb;
  EXPECT_EQ(LargestDifference(FromMessage(message), image), 0);
}

TEST(ImageMessage, CarriesFilesAsTheyAre) {
  const auto png = Encoded(Picture(), ".png");
  const image_t message = EncodedToMessage(png, 12, 3);
  EXPECT_EQ(message.pixelformat, kPixelPng);
  EXPECT_EQ(message.width, 40);
  EXPECT_EQ(message.height, 24);
  EXPECT_EQ(message.row_stride, 0);
  EXPECT_EQ(message.data, png);
  EXPECT_EQ(LargestDifference(FromMessage(message), Picture()), 0);
}

TEST(ImageMessage, DecodesJpeg) {
  for (const cv::Mat& image : {Picture(), GrayPicture()}) {
    const image_t message = EncodedToMessage(Encoded(image, ".jpg"), 12, 3);
    EXPECT_EQ(message.pixelformat, kPixelMjpeg);
    EXPECT_EQ(message.width, 40);
    EXPECT_EQ(message.height, 24);
    // Smooth grey at quality 95 is off by a few levels; colours by more, as they are halved in
    // size.
    EXPECT_LT(LargestDifference(FromMessage(message), image), 25);
  }
}

TEST(ImageMessage, IsReadInGrey) {
  cv::Mat grey;
  cv::cvtColor(Picture(), grey, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(LargestDifference(GreyFromMessage(ToMessage(Picture(), 0, 1)), grey), 0);
  EXPECT_EQ(LargestDifference(GreyFromMessage(ToMessage(grey, 0, 1)), grey), 0);
  const image_t png = EncodedToMessage(Encoded(Picture(), ".png"), 0, 1);
  EXPECT_EQ(LargestDifference(GreyFromMessage(png), grey), 0);
  // By the loss of the compression alone, which leaves brightness whole.
  const image_t jpeg = EncodedToMessage(Encoded(Picture(), ".jpg"), 0, 1);
  EXPECT_LT(LargestDifference(GreyFromMessage(jpeg), grey), 6);
}

TEST(ImageMessage, RefusesToSendOtherFiles) {
  EXPECT_THROW(EncodedToMessage({}, 0, 1), std::runtime_error);
  EXPECT_THROW(EncodedToMessage({'B', 'M', 0, 0}, 0, 1), std::runtime_error);
}

TEST(ImageMessage, TellsWhenAFileIsCutOff) {
  for (const std::string extension : {".png", ".jpg"}) {
    const auto bytes = Encoded(Picture(), extension);
    image_t message = EncodedToMessage(bytes, 0, 1);
    for (const double share : {0.0, 0.01, 0.1, 0.5, 0.9, 0.99}) {
      message.data = bytes;
      message.data.resize(static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
      message.size = static_cast<std::int32_t>(message.data.size());
      EXPECT_NE(CauseOf(message), "none") << extension << " " << share;
    }
  }
}

TEST(ImageMessage, TellsWhenAPngIsDamaged) {
  image_t message = EncodedToMessage(Encoded(Picture(), ".png"), 0, 1);
  message.data[message.data.size() / 2] ^= 0xFF;
  EXPECT_THAT(CauseOf(message), HasSubstr("PNG cannot be decoded"));
}

TEST(ImageMessage, SurvivesDamageAnywhere) {
  for (const std::string extension : {".png", ".jpg"}) {
    const image_t whole = EncodedToMessage(Encoded(Picture(), extension), 0, 1);
    for (std::size_t i = 0; i < whole.data.size(); ++i) {
      image_t message = whole;
      message.data[i] ^= 0xFF;
      CauseOf(message);  // an image or a std::runtime_error, never anything else
    }
  }
}

struct Broken {
  std::string what;
  std::function<void(image_t*)> breaking;
};

class BrokenImage : public testing::TestWithParam<Broken> {};

TEST_P(BrokenImage, IsRefusedWithItsCause) {
  image_t message = ToMessage(Picture(), 0, 1);
  GetParam().breaking(&message);
  EXPECT_THAT(CauseOf(message), HasSubstr(GetParam().what));
}

INSTANTIATE_TEST_SUITE_P(
    Causes,
    BrokenImage,
    testing::Values(Broken{"0 x 24 px", [](auto* m) { m->width = 0; }},
                    Broken{"40 x -1 px", [](auto* m) { m->height = -1; }},
                    Broken{"need", [](auto* m) { m->height = INT32_MAX; }},
                    Broken{"row_stride", [](auto* m) { m->width = INT32_MAX; }},
                    Broken{"row_stride", [](auto* m) { m->row_stride = -120; }},
                    Broken{"size is 2881", [](auto* m) { m->size = 2881; }},
                    Broken{"size is -1", [](auto* m) { m->size = -1; }},
                    Broken{"pixelformat 7", [](auto* m) { m->pixelformat = 7; }},
                    Broken{"no JPEG", [](auto* m) { m->pixelformat = kPixelMjpeg; }},
                    Broken{"no PNG", [](auto* m) { m->pixelformat = kPixelPng; }},
                    Broken{"says 41 x 24", [](auto* m) {
                             *m = EncodedToMessage(Encoded(Picture(), ".jpg"), 0, 1);
                             m->width = 41;
                           }}));

TEST(ImageMessage, IsRefusedBeforeItsHeaderCanAskForGigabytes) {
  auto bytes = Encoded(Picture(), ".jpg");
  const std::vector<std::uint8_t> size = {8, 0, 24, 0, 40};  // SOF0: bits a sample, height, width
  const auto at = std::search(bytes.begin(), bytes.end(), size.begin(), size.end());
  ASSERT_NE(at, bytes.end());
  at[1] = at[2] = at[3] = at[4] = 0xFD;
  const image_t message = EncodedToMessage(bytes, 0, 1);
  EXPECT_EQ(message.width, 65021);
  EXPECT_THAT(CauseOf(message), HasSubstr("65021 x 65021 px are too many"));
}

/// OpenCV's memory, of which nothing is left.
class NoMemory : public cv::MatAllocator {
 public:
  NoMemory() { cv::Mat::setDefaultAllocator(this); }
  ~NoMemory() override { cv::Mat::setDefaultAllocator(cv::Mat::getStdAllocator()); }
  NoMemory(const NoMemory&) = delete;
  NoMemory& operator=(const NoMemory&) = delete;

 private:
  cv::UMatData* allocate(int,
                         const int*,
                         int,
                         void*,
                         std::size_t*,
                         cv::AccessFlag,
                         cv::UMatUsageFlags) const override {
    throw cv::Exception(cv::Error::StsNoMem, "none left", "allocate", __FILE__, __LINE__);
  }
  bool allocate(cv::UMatData*, cv::AccessFlag, cv::UMatUsageFlags) const override { return false; }
  void deallocate(cv::UMatData*) const override {}
};

TEST(ImageMessage, IsRefusedIfThereIsNoMemoryForIt) {
  for (const std::string extension : {".png", ".jpg"}) {
    const image_t message = EncodedToMessage(Encoded(Picture(), extension), 0, 1);
    const NoMemory no_memory;
    EXPECT_THAT(CauseOf(message), HasSubstr("cannot be decoded: no memory for it"));
  }
}

TEST(InspectEncodedImage, SurvivesEveryShortFile) {
  for (const std::string extension : {".png", ".jpg"}) {
    const auto bytes = Encoded(Picture(), extension);
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      const auto info =
          InspectEncodedImage({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)});
      if (info) {
        EXPECT_EQ(info->width_px, 40);
      }
    }
  }
}

CameraModel Camera() {
  CameraModel camera;
  camera.lens = LensModel::kEquidistant;
  camera.width_px = 1920;
  camera.height_px = 1208;
  camera.fx_px = 1176.931662006163;
  camera.fy_px = 1177.715660133758;
  camera.cx_px = 962.2754188883206;
  camera.cy_px = 612.7245350750861;
  camera.distortion = {-0.0540096, -0.0784275, 0.0959641, -0.0515253};
  return camera;
}

TEST(CameraInfoMessage, ComesBackExactly) {
  const CameraModel camera = Camera();
  const camera_info_t message = ToMessage(camera, 12, 3);
  EXPECT_EQ(message.utime, 12);
  EXPECT_EQ(message.seq, 3);
  const CameraModel back = FromMessage(message);
  EXPECT_EQ(back.lens, camera.lens);
  EXPECT_EQ(back.width_px, camera.width_px);
  EXPECT_EQ(back.height_px, camera.height_px);
  EXPECT_EQ(back.fx_px, camera.fx_px);
  EXPECT_EQ(back.fy_px, camera.fy_px);
  EXPECT_EQ(back.cx_px, camera.cx_px);
  EXPECT_EQ(back.cy_px, camera.cy_px);
  EXPECT_EQ(back.distortion, camera.distortion);
}

TEST(CameraInfoMessage, IsRefusedIfUnusable) {
  camera_info_t unknown = ToMessage(Camera(), 12, 3);
  unknown.lens_model = "periscope";
  EXPECT_THROW(FromMessage(unknown), std::runtime_error);
  camera_info_t broken = ToMessage(Camera(), 12, 3);
  broken.fx_px = -1;
  EXPECT_THROW(FromMessage(broken), std::runtime_error);
}

}  // namespace
}  // namespace voqcal
