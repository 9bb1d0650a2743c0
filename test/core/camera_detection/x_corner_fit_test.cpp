#include "core/camera_detection/x_corner_fit.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "support/spoilt_image.hpp"

namespace voqcal {
namespace {

constexpr int kSizePx = 31;
constexpr double kDark = 30;
constexpr double kBright = 220;

Eigen::Vector2d Direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Two edges that cross, by 20 x 20 rays a pixel.
cv::Mat Render(const Eigen::Vector2d& corner_px, double angle_x_rad, double angle_y_rad) {
  constexpr int kRays = 20;
  const Eigen::Vector2d edge_x = Direction(angle_x_rad);
  const Eigen::Vector2d edge_y = Direction(angle_y_rad);
  cv::Mat image(kSizePx, kSizePx, CV_8UC1);
  for (int y = 0; y < kSizePx; ++y) {
    for (int x = 0; x < kSizePx; ++x) {
      int num_bright = 0;
      for (int ray = 0; ray < kRays * kRays; ++ray) {
        const Eigen::Vector2d in_pixel(ray % kRays + 0.5, ray / kRays + 0.5);
        const Eigen::Vector2d at_px = Eigen::Vector2d(x - 0.5, y - 0.5) + in_pixel / kRays;
        const Eigen::Vector2d from_corner = at_px - corner_px;
        if (Cross(edge_x, from_corner) * Cross(edge_y, from_corner) > 0) ++num_bright;
      }
      const double share = num_bright / static_cast<double>(kRays * kRays);
      image.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(kDark + share * (kBright - kDark));
    }
  }
  return image;
}

// As a finder gives it: the place to 0.3 px, the edges to a few degrees.
XCornerGuess NearTo(const Eigen::Vector2d& corner_px, double angle_x_rad, double angle_y_rad) {
  return {corner_px + Eigen::Vector2d(0.2, -0.2),
          6 * Direction(angle_x_rad + 0.05),
          6 * Direction(angle_y_rad - 0.05)};
}

TEST(FitXCorner, IsRightWhereverInAPixelTheCornerLies) {
  // Grey levels are whole numbers and a pixel's square is fitted by a Gaussian; cv::cornerSubPix is
  // off by 0.08 px here.
  constexpr double kTolerancePx = 0.03;
  for (const double blur_px : {0.0, 0.7, 1.5}) {
    for (const double angle_rad : {0.1, 0.7, 2.0}) {
      for (int phase = 0; phase < 5; ++phase) {
        const Eigen::Vector2d corner_px(15 + 0.2 * phase, 15 + 0.37 * phase);
        const double other_rad = angle_rad + 1.3;  // 75 degrees: seen askew
        const cv::Mat image = test::Blurred(Render(corner_px, angle_rad, other_rad), blur_px);
        const auto found = FitXCorner(image, NearTo(corner_px, angle_rad, other_rad));
        ASSERT_TRUE(found) << blur_px << ", " << angle_rad << ", " << phase;
        EXPECT_LT((*found - corner_px).norm(), kTolerancePx)
            << blur_px << ", " << angle_rad << ", " << phase;
      }
    }
  }
}

TEST(FitXCorner, FindsNothingWhereThereIsNone) {
  const Eigen::Vector2d middle_px(15, 15);
  const XCornerGuess guess = NearTo(middle_px, 0, M_PI / 2);
  EXPECT_FALSE(FitXCorner(cv::Mat(kSizePx, kSizePx, CV_8UC1, cv::Scalar(90)), guess));
  cv::Mat edge(kSizePx, kSizePx, CV_8UC1, cv::Scalar(kDark));
  edge.colRange(15, kSizePx).setTo(kBright);
  EXPECT_FALSE(FitXCorner(edge, guess));
  edge.rowRange(15, kSizePx).setTo(kDark);  // the corner of one bright square
  EXPECT_FALSE(FitXCorner(edge, guess));
}

TEST(FitXCorner, FindsNothingAtTheBorderOrFarAway) {
  const cv::Mat image = Render({15, 15}, 0.1, 1.6);
  const Eigen::Vector2d edge_x(6, 0);
  const Eigen::Vector2d edge_y(0, 6);
  EXPECT_FALSE(FitXCorner(image, {{3, 15}, edge_x, edge_y}));
  EXPECT_FALSE(FitXCorner(image, {{15, 26}, edge_x, edge_y}));
  EXPECT_FALSE(FitXCorner(image, {{19, 15}, edge_x, edge_y}));
  EXPECT_FALSE(FitXCorner(image, {{15, 15}, edge_x, edge_x}));
}

}  // namespace
}  // namespace voqcal
