#include "core/camera_detection/corner_links.hpp"

#include <gtest/gtest.h>

namespace voqcal {
namespace {

/// Two corners 20 px apart along x, the second off by `tangent` times that along y.
std::vector<XCorner> TwoCorners(float tangent) {
  XCorner first;
  first.position_px = {100, 100};
  first.axes = {cv::Point2f(1, 0), cv::Point2f(0, 1)};
  first.contrast = 50;
  XCorner second;
  second.position_px = first.position_px + cv::Point2f(20, 20 * tangent);
  second.axes = {cv::Point2f(0, 1), cv::Point2f(-1, 0)};  // dark and bright change places
  second.contrast = 50;
  return {first, second};
}

TEST(LinkCorners, JoinsNeighboursUpToTheLimit) {
  const CornerLinks links = LinkCorners(TwoCorners(0.3599F));
  EXPECT_EQ(links[0], (std::array<int, kNumWays>{1, kNoCorner, kNoCorner, kNoCorner}));
  EXPECT_EQ(links[1], (std::array<int, kNumWays>{kNoCorner, 0, kNoCorner, kNoCorner}));
  EXPECT_EQ(LinkCorners(TwoCorners(0.3601F))[0][0], kNoCorner);
}

TEST(LinkCorners, TakesTheNearestOfAll) {
  std::vector<XCorner> corners = TwoCorners(0);
  // Farther ones along the same line, enough of them to fill several of the machine's vectors.
  for (int i = 2; i < 40; ++i) {
    corners.insert(corners.begin() + 1, corners.back());
    corners[1].position_px.x += static_cast<float>(20 * i);
  }
  EXPECT_EQ(LinkCorners(corners)[0][0], 39);
}

}  // namespace
}  // namespace voqcal
