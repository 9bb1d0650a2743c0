#include "core/lidar_detection/outline_checks.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

constexpr double kMaxShortM = 0.05;
constexpr std::array<bool, 4> kAllCovered = {true, true, true, true};

/// Hits come up to it, and misses show that it ends.
OutlineEdge ShownEdge() {
  OutlineEdge edge;
  edge.num_hits = 20;
  edge.num_misses = 20;
  edge.reach_m = 0.0;
  return edge;
}

/// Four of the sixteen fields have no hit.
Agreement ThreeQuartersCovered(double empty) {
  Agreement agreement;
  agreement.covered = 0.75;
  agreement.covered_half = {0.5, 0.75, 1.0, 0.75};
  agreement.empty = empty;
  return agreement;
}

TEST(OpenEdge, IsNoneWhereGapsLeaveFieldsUnseenInAShownOutline) {
  const std::array<OutlineEdge, 4> edges = {ShownEdge(), ShownEdge(), ShownEdge(), ShownEdge()};
  EXPECT_FALSE(OpenEdge(edges, kAllCovered, ThreeQuartersCovered(0.0), kMaxShortM));
  // The same fields seen and empty: a board cut off there, or a frame.
  EXPECT_EQ(OpenEdge(edges, kAllCovered, ThreeQuartersCovered(0.25), kMaxShortM), 0U);
}

TEST(OpenEdge, GapsAreNoExcuseWhereOneEdgeIsNotShown) {
  std::array<OutlineEdge, 4> edges = {ShownEdge(), ShownEdge(), ShownEdge(), ShownEdge()};
  edges[2].reach_m = -0.04;  // the hits end short of it
  EXPECT_TRUE(OpenEdge(edges, kAllCovered, ThreeQuartersCovered(0.0), kMaxShortM));
  edges[2] = ShownEdge();
  edges[2].num_misses = 1;  // a stray one
  EXPECT_TRUE(OpenEdge(edges, kAllCovered, ThreeQuartersCovered(0.0), kMaxShortM));
  edges[2] = ShownEdge();
  edges[2].num_hits = 0;
  EXPECT_TRUE(OpenEdge(edges, kAllCovered, ThreeQuartersCovered(0.0), kMaxShortM));
}

TEST(Compare, TellsFieldsThatNoBeamMeetsFromEmptyOnes) {
  OutlineModel model;
  model.width_m = 0.6;
  model.height_m = 0.8;
  std::vector<OutlineBeam> unseen;  // beams 2 cm apart, but for the four fields in the middle
  std::vector<OutlineBeam> empty;
  for (double x_m = -0.29; x_m < 0.3; x_m += 0.02) {
    for (double y_m = -0.39; y_m < 0.4; y_m += 0.02) {
      const bool is_middle = std::abs(x_m) < 0.15 && std::abs(y_m) < 0.2;
      if (!is_middle) unseen.push_back({{x_m, y_m}, true});
      empty.push_back({{x_m, y_m}, !is_middle});
    }
  }
  EXPECT_EQ(Compare(unseen, {}, model, {}).empty, 0.0);
  EXPECT_EQ(Compare(empty, {}, model, {}).empty, 0.25);
  EXPECT_EQ(Compare(empty, {}, model, {}).covered, 0.75);
}

}  // namespace
}  // namespace voqcal
