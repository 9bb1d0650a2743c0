#include "camera_driver/genicam_pixels.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace voqcal {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kWidth = 8;
constexpr int kHeight = 6;
const cv::Vec3b kColour(50, 100, 200);  // blue, green, red

GenicamFrame FrameOf(std::uint32_t format, const Bytes& bytes, int row_padding_bytes = 0) {
  return {format, kWidth, kHeight, row_padding_bytes, bytes.data(), bytes.size()};
}

void ExpectAllOf(const GenicamFrame& frame, const cv::Vec3b& colour, int tolerance = 0) {
  const auto picture = PictureOf(frame);
  ASSERT_TRUE(picture);
  ASSERT_EQ(picture->type(), CV_8UC3);
  ASSERT_EQ(picture->size(), cv::Size(kWidth, kHeight));
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(picture->at<cv::Vec3b>(2, 3)[channel], colour[channel], tolerance) << channel;
    EXPECT_NEAR(picture->at<cv::Vec3b>(3, 4)[channel], colour[channel], tolerance) << channel;
  }
}

/// One colour, by the four letters of the mosaic's first pixels: "RGGB".
Bytes Mosaic(const std::string& pattern) {
  Bytes bytes;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const char letter = pattern.at(2 * (y % 2) + x % 2);
      bytes.push_back(kColour[letter == 'B' ? 0 : letter == 'G' ? 1 : 2]);
    }
  }
  return bytes;
}

Bytes Repeated(const Bytes& piece, int num) {
  Bytes bytes;
  for (int i = 0; i < num; ++i) bytes.insert(bytes.end(), piece.begin(), piece.end());
  return bytes;
}

TEST(GenicamPixels, HaveTheirColoursInEveryMosaic) {
  ExpectAllOf(FrameOf(0x01080009, Mosaic("RGGB")), kColour);
  ExpectAllOf(FrameOf(0x0108000B, Mosaic("BGGR")), kColour);
  ExpectAllOf(FrameOf(0x01080008, Mosaic("GRBG")), kColour);
  ExpectAllOf(FrameOf(0x0108000A, Mosaic("GBRG")), kColour);
}

TEST(GenicamPixels, HaveTheirColoursInEitherOrder) {
  ExpectAllOf(FrameOf(0x02180014, Repeated({200, 100, 50}, kWidth * kHeight)), kColour);
  ExpectAllOf(FrameOf(0x02180015, Repeated({50, 100, 200}, kWidth * kHeight)), kColour);
}

TEST(GenicamPixels, HaveTheirColoursByBrightnessAndHue) {
  // BT.601 with 16 to 235 for black to white.
  constexpr std::uint8_t kY = 123;
  constexpr std::uint8_t kU = 91;
  constexpr std::uint8_t kV = 175;
  const int num = kWidth * kHeight / 2;
  ExpectAllOf(FrameOf(0x02100032, Repeated({kY, kU, kY, kV}, num)), kColour, 3);
  ExpectAllOf(FrameOf(0x0210001F, Repeated({kU, kY, kV, kY}, num)), kColour, 3);
}

TEST(GenicamPixels, LeaveThePaddingOfRowsOut) {
  Bytes bytes;
  for (int y = 0; y < kHeight; ++y) {
    bytes.insert(bytes.end(), kWidth, static_cast<std::uint8_t>(10 * y));
    bytes.insert(bytes.end(), 3, 255);
  }
  bytes.resize(bytes.size() - 3);  // the last row needs none
  const auto picture = PictureOf(FrameOf(0x01080001, bytes, 3));
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->type(), CV_8UC1);
  for (int y = 0; y < kHeight; ++y) EXPECT_EQ(picture->at<std::uint8_t>(y, 7), 10 * y);
}

TEST(GenicamPixels, AreNoneWhereBytesAreMissingOrTheFormatIsAnother) {
  const Bytes bytes(kWidth * kHeight);
  EXPECT_TRUE(PictureOf(FrameOf(0x01080001, bytes)));
  EXPECT_FALSE(PictureOf(FrameOf(0x01080001, bytes, 1)));
  EXPECT_FALSE(PictureOf(FrameOf(0x02180014, bytes)));
  EXPECT_FALSE(PictureOf(FrameOf(0x01100005, bytes)));  // Mono12
  EXPECT_FALSE(PictureOf({0x01080001, 0, 0, 0, nullptr, 0}));
}

}  // namespace
}  // namespace voqcal
