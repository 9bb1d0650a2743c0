#include "core/camera_detection/x_corners.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace voqcal {
namespace {

using ::testing::SizeIs;

// Pixels are asked in blocks: of whatever width, none at the end of a row is left out.
TEST(FindXCorners, FindsThemUpToTheLastColumns) {
  constexpr int kFromRightPx = 10;
  constexpr int kRows = 40;
  for (int columns = 64; columns < 64 + 40; ++columns) {
    cv::Mat image(kRows, columns, CV_8UC1, cv::Scalar(40));
    const int x = columns - kFromRightPx;
    image(cv::Rect(0, 0, x, kRows / 2)).setTo(200);
    image(cv::Rect(x, kRows / 2, kFromRightPx, kRows / 2)).setTo(200);
    cv::GaussianBlur(image, image, cv::Size(), 0.8);
    const std::vector<XCorner> corners = FindXCorners(image, 10);
    ASSERT_THAT(corners, SizeIs(1)) << columns;
    EXPECT_NEAR(corners[0].position_px.x, static_cast<float>(x) - 0.5F, 0.1F) << columns;
  }
}

}  // namespace
}  // namespace voqcal
