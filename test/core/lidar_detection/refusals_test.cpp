// What the detector says of boards that it must not take, and of sweeps that are none.

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/lidar_detection/lidar_board.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal {
namespace {

using test::FacingBoard;
using test::SynthesizeLidarBoard;
using test::SyntheticBox;
using test::SyntheticLidarBoardOptions;

const BoardSpec kBoard = SyntheticLidarBoardOptions().board;

std::string VerdictOn(const PointCloud& cloud) {
  const auto found = DetectLidarBoard(cloud, kBoard, {});
  return found ? "found" : ToString(found.error());
}

/// The sides of the board that is found: "measured measured hidden measured" in the order bottom,
/// right, top, left of a board that is held upright; or why there is none.
std::string SidesOf(const PointCloud& cloud) {
  const auto found = DetectLidarBoard(cloud, kBoard, {});
  if (!found) return ToString(found.error());
  std::string text;
  for (const SideView view : found->front().sides)
    text += (text.empty() ? "" : " ") + ToString(view);
  return text;
}

SyntheticLidarBoardOptions UprightBoard() {
  SyntheticLidarBoardOptions scene;
  scene.noise_m = 0.01;
  scene.T_lidar_board = FacingBoard({2.3, 0.0, 0.0}, 0.0);
  return scene;
}

/// At half the board's distance, so that it hides twice its size.
SyntheticBox Pillar(double y_m, double half_width_m) {
  SyntheticBox box;
  box.T_lidar_box.translation() = Eigen::Vector3d(1.15, y_m, 0.0);
  box.half_m = {0.02, half_width_m, 0.6};
  return box;
}

TEST(LidarBoardVerdict, HiddenSideIsOpen) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  EXPECT_EQ("measured measured measured measured", SidesOf(SynthesizeLidarBoard(scene)));
  scene.boxes.push_back(Pillar(0.3, 0.24));  // from y = 0.06 m, 0.12 m on the board, to the left
  EXPECT_EQ("measured measured measured hidden", SidesOf(SynthesizeLidarBoard(scene)));
  scene.boxes.back() = Pillar(-0.3, 0.24);
  EXPECT_EQ("measured hidden measured measured", SidesOf(SynthesizeLidarBoard(scene)));
}

TEST(LidarBoardVerdict, BoardOfWhichMostIsHiddenMayBeSomethingElse) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.boxes.push_back(Pillar(0.25, 0.3));  // from y = -0.05 m, -0.1 m on the board, to the left
  EXPECT_NE("found", VerdictOn(SynthesizeLidarBoard(scene)));
}

// It may go on there: a crate of the board's width does.
TEST(LidarBoardVerdict, SideBeyondTheFieldOfViewIsOpenAndLeavesItUnsure) {
  const PointCloud whole = SynthesizeLidarBoard(UprightBoard());
  PointCloud cut = whole;
  cut.points.clear();
  for (const LidarPoint& point : whole.points) {
    // A sensor that sees no farther to the left than 0.2 m from the board's middle.
    if (point.position_m.y() < 0.2F / 2.3F * point.position_m.x()) cut.points.push_back(point);
  }
  const auto found = DetectLidarBoard(cut, kBoard, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(ToString(found.error()), "leaves the field of view on the left");
  ASSERT_EQ(found.error().unsure.size(), 1u);
  EXPECT_EQ(NumMeasuredSides(found.error().unsure[0]), 3);
  EXPECT_EQ(found.error().unsure[0].sides[3], SideView::kCutOff);
}

TEST(LidarBoardVerdict, BoardThatStandsOnTheGroundIsJoinedToIt) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  scene.T_lidar_board = FacingBoard({5.2, 0.0, -1.3 + 0.425}, 0.0);
  scene.T_lidar_board.linear() << 0, 0, -1, 1, 0, 0, 0, 1, 0;  // upright
  scene.T_lidar_board.linear().col(0) *= -1;
  const PointCloud cloud = SynthesizeLidarBoard(scene);
  const auto found = DetectLidarBoard(cloud, kBoard, {});
  ASSERT_TRUE(found) << ToString(found.error());
  const LidarBoard& board = found->front();
  EXPECT_EQ(board.sides[0], SideView::kJoined);
  EXPECT_EQ(NumMeasuredSides(board), 3);
  // The top edge and the known height tell it to a few millimetres.
  EXPECT_LT((board.pose.centre_m - scene.T_lidar_board.translation()).norm(), 0.015);
  EXPECT_TRUE(std::isnan(board.edge_lengths_m[1]));
  EXPECT_FALSE(std::isnan(board.edge_lengths_m[0]));
}

/// Without the beams that meet the plane at x = 2.3 m between two heights: petals of a rosette
/// leave such gaps.
PointCloud WithoutBand(const PointCloud& whole, float low_m, float high_m) {
  PointCloud gappy = whole;
  gappy.points.clear();
  for (const LidarPoint& point : whole.points) {
    const float height_m = point.position_m.z() / point.position_m.x() * 2.3F;
    if (height_m < low_m || height_m > high_m) gappy.points.push_back(point);
  }
  return gappy;
}

TEST(LidarBoardVerdict, BoardIsOneOnBothSidesOfAGapOfTheScan) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  const PointCloud whole = SynthesizeLidarBoard(scene);
  // Of its 0.85 m as much as 0.42 are not seen, nearly three of the cells that patches grow in.
  for (const auto& [low_m, high_m] :
       {std::pair(-0.2F, 0.2F), std::pair(-0.21F, 0.21F), std::pair(-0.1F, 0.3F)}) {
    const auto found = DetectLidarBoard(WithoutBand(whole, low_m, high_m), kBoard, {});
    ASSERT_TRUE(found) << low_m << ' ' << ToString(found.error());
    // 10 mm of noise on 500 points: a millimetre for the plane, a few for the outline.
    EXPECT_LT((found->front().pose.centre_m - Eigen::Vector3d(2.3, 0, 0)).norm(), 0.01) << low_m;
  }
}

TEST(LidarBoardVerdict, FrameIsNoBoardWithAGap) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  PointCloud cloud = SynthesizeLidarBoard(scene);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    Eigen::Vector3f& position_m = cloud.points[i].position_m;
    const bool is_board = position_m.x() < 2.5F && position_m.z() > -0.5F;
    const bool is_middle = std::abs(position_m.y()) < 0.15F && std::abs(position_m.z()) < 0.21F;
    // Through the hole most beams meet the wall; every eighth, a wire.
    if (is_board && is_middle && i % 8 != 0) position_m *= 7.0F / position_m.x();
  }
  EXPECT_NE("found", VerdictOn(cloud));
}

TEST(LidarBoardVerdict, GapOfTheScanAtAnEdgeLeavesItOpen) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  // The uppermost 0.2 m and whatever is above it; higher up the sensor sees the wall.
  const std::string sides = SidesOf(WithoutBand(SynthesizeLidarBoard(scene), 0.225F, 0.6F));
  EXPECT_EQ("measured measured in a gap measured", sides);
}

TEST(LidarBoardVerdict, StripOfTheBoardsWidthMayBeAnything) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  scene.board.height_m = 1.25;  // patches may be so long
  const auto found = DetectLidarBoard(SynthesizeLidarBoard(scene), kBoard, {});
  EXPECT_FALSE(found);
}

TEST(LidarBoardVerdict, SurfaceOfAnotherWidthIsNoneHoweverItIsCut) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  scene.board.width_m = 0.74;
  scene.boxes.push_back(Pillar(0.0, 0.6));
  scene.boxes.back().half_m.z() = 0.1;
  scene.boxes.back().T_lidar_box.translation().z() = -0.2;  // its lower fifth and what is below
  EXPECT_NE("found", VerdictOn(SynthesizeLidarBoard(scene)));
}

TEST(LidarBoardVerdict, EdgeOfWhichAPartIsShownIsProven) {
  // Something stands before the surroundings on the right, but for the upper third of the edge.
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  scene.boxes.push_back(Pillar(-0.25, 0.08));
  scene.boxes.back().half_m.z() = 0.2;
  scene.boxes.back().T_lidar_box.translation().z() = -0.13;  // up to 0.14 m of 0.42 m on the board
  EXPECT_EQ("found", VerdictOn(SynthesizeLidarBoard(scene)));
}

TEST(LidarBoardVerdict, TwoEqualBoardsBeforeNothingAreAmbiguous) {
  // Without misses every log-likelihood is negative: a share of the best would be above it.
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.has_wall = scene.has_floor = false;
  scene.num_rings = 64;
  SyntheticBox twin;
  scene.T_lidar_board.translation().y() = -0.75;
  twin.T_lidar_box.translation() = Eigen::Vector3d(2.301, 0.75, 0.0);
  twin.half_m = {0.001, kBoard.width_m / 2, kBoard.height_m / 2};
  scene.boxes.push_back(twin);
  const auto found = DetectLidarBoard(SynthesizeLidarBoard(scene), kBoard, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().miss, LidarBoardMiss::kAmbiguous);
  EXPECT_EQ(found.error().unsure.size(), 2U);
}

TEST(LidarBoardVerdict, BoardSeenFlatIsNamed) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 128;
  scene.noise_m = 0.001;
  for (const double tilt_deg : {60.0, 75.0}) {
    scene.T_lidar_board = FacingBoard({2.3, 0.0, 0.0}, 0.0, tilt_deg);
    EXPECT_EQ(tilt_deg < 70 ? "found" : "seen at too flat an angle",
              VerdictOn(SynthesizeLidarBoard(scene)))
        << tilt_deg;
  }
}

TEST(LidarBoardVerdict, BoardThatAFewLinesLeaveTooMuchPlayIsTooLoose) {
  const PointCloud cloud = SynthesizeLidarBoard(UprightBoard());
  LidarBoardOptions strict;
  strict.max_corner_sigma_m = 0.002;
  const auto found = DetectLidarBoard(cloud, kBoard, strict);
  ASSERT_FALSE(found);
  EXPECT_EQ(ToString(found.error()), "too few beams tell its outline");
}

TEST(LidarBoardVerdict, BentBoardIsNamedWithItsBend) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  PointCloud cloud = SynthesizeLidarBoard(scene);
  for (LidarPoint& point : cloud.points) {
    // Bent about a vertical line by 40 mm at both sides; past the board nothing changes.
    const double y_m = point.position_m.y();
    const bool is_board = std::abs(point.position_m.x() - 2.3F) < 0.1F && std::abs(y_m) < 0.32;
    if (is_board) point.position_m.x() += static_cast<float>(0.04 * std::pow(y_m / 0.305, 2));
  }
  const auto found = DetectLidarBoard(cloud, kBoard, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().miss, LidarBoardMiss::kBent);
  // 10 mm of noise on some 500 points: about 1 mm.
  const std::string detail = found.error().detail;
  EXPECT_GE(detail, "by 36 mm");
  EXPECT_LE(detail, "by 44 mm");
}

TEST(LidarBoardVerdict, FlatBoardIsNotBentByOffsetsOfScanLines) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SyntheticLidarBoardOptions scene = UprightBoard();
    scene.seed = seed;
    PointCloud cloud = SynthesizeLidarBoard(scene);
    std::mt19937 random(seed);
    std::vector<float> offset_m;  // of each ring: 10 mm (1 sigma)
    for (int ring = 0; ring < scene.num_rings; ++ring) {
      offset_m.push_back(static_cast<float>(0.01 * test::UnitGaussian(&random)));
    }
    for (LidarPoint& point : cloud.points) {
      point.position_m += offset_m[point.ring] * point.position_m.normalized();
    }
    EXPECT_EQ("found", VerdictOn(cloud)) << seed;
  }
}

TEST(LidarBoardVerdict, OnePlaneOnlyHasNoBoard) {
  SyntheticLidarBoardOptions scene;
  scene.has_board = false;
  scene.has_floor = false;
  EXPECT_EQ("no plane of the board's size", VerdictOn(SynthesizeLidarBoard(scene)));
}

TEST(LidarBoardVerdict, EmptyAndBrokenCloudsHaveTooFewPoints) {
  PointCloud cloud;
  EXPECT_EQ("too few points", VerdictOn(cloud));
  cloud.points.resize(10000);
  EXPECT_EQ("too few points", VerdictOn(cloud));  // at the origin: no returns
  for (LidarPoint& point : cloud.points) {
    point.position_m.setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  EXPECT_EQ("too few points", VerdictOn(cloud));
}

TEST(LidarBoardVerdict, TwoMillionPointsAreMeasuredToo) {
  SyntheticLidarBoardOptions scene = UprightBoard();
  scene.num_rings = 64;
  const PointCloud sweep = SynthesizeLidarBoard(scene);
  PointCloud dense = sweep;
  std::mt19937 random(2);
  while (dense.points.size() < 2000000) {
    LidarPoint point = sweep.points[dense.points.size() % sweep.points.size()];
    point.position_m *= static_cast<float>(1.0 + 0.003 * test::UnitGaussian(&random));
    dense.points.push_back(point);
  }
  EXPECT_EQ("found", VerdictOn(dense));
}

}  // namespace
}  // namespace voqcal
