#include "core/camera_detection/corner_links.hpp"

#include <array>
#include <cmath>
#include <random>

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

/// The rule itself, without the search's shortcut.
bool IsNext(const XCorner& from, const XCorner& to, int axis) {
  const cv::Point2f step = to.position_px - from.position_px;
  const float along = step.dot(from.axes[axis]);
  return std::abs(step.cross(from.axes[axis])) < 0.36F * std::abs(along) &&
         MayJoin(from, to, along > 0 ? axis : axis + 2, step);
}

bool AreJoined(const XCorner& from, const XCorner& to) {
  const auto is_next = [](const XCorner& a, const XCorner& b) {
    return IsNext(a, b, 0) || IsNext(a, b, 1);
  };
  return is_next(from, to) && is_next(to, from);
}

TEST(LinkCorners, JoinsWhatTheRuleJoins) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> angle(-3.1416F, 3.1416F);
  std::normal_distribution<float> skew(0, 0.2F);
  const auto axis = [](float rad) { return cv::Point2f(std::cos(rad), std::sin(rad)); };
  int num_joined = 0;
  for (int i = 0; i < 20000; ++i) {
    const float along = angle(random);
    std::vector<XCorner> corners = TwoCorners(0);
    corners[0].axes = {axis(along + skew(random)), axis(along + 1.57F + skew(random))};
    corners[1].axes = {axis(along + 1.57F + skew(random)), axis(along + 3.14F + skew(random))};
    corners[1].position_px = corners[0].position_px + 20 * axis(along);
    const CornerLinks links = LinkCorners(corners);
    const bool are_joined = links[0] != std::array{kNoCorner, kNoCorner, kNoCorner, kNoCorner};
    EXPECT_EQ(are_joined, AreJoined(corners[0], corners[1])) << i;
    num_joined += are_joined ? 1 : 0;
  }
  EXPECT_GT(num_joined, 2000);  // both answers are tried
  EXPECT_LT(num_joined, 18000);
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
