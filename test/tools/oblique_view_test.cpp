#include "report/oblique_view.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.hpp"
#include "report/median_range_scene.hpp"

namespace voqcal {
namespace {

const cv::Vec3b kRed(0, 0, 200);
const cv::Vec3b kBlue(200, 0, 0);

/// A camera and a lidar that are one: x right, y down, z forward.
BoardPose BoardTurned(double turn_deg) {
  BoardPose board;
  board.centre_m = {0, 0, 3};
  board.normal = {std::sin(turn_deg * kRadPerDeg), 0, -std::cos(turn_deg * kRadPerDeg)};
  board.corners_m.fill(board.centre_m + Eigen::Vector3d(0, 0.5, 0));
  return board;
}

TEST(ObliqueView, LooksAtTheBoardFromAboveOnTheSideOfItsFace) {
  for (const double turn_deg : {-30.0, 30.0}) {
    const auto view = ObliqueViewOf(BoardTurned(turn_deg), Eigen::Isometry3d::Identity());
    const Eigen::Vector3d centre_view_m = view.T_view_lidar * Eigen::Vector3d(0, 0, 3);
    EXPECT_TRUE(centre_view_m.isApprox(Eigen::Vector3d(0, 0, 3)));
    EXPECT_NEAR(view.focal_px * 0.5 / 3, 130, 1e-9);
    EXPECT_NEAR(view.nearest_m, 1.5, 1e-9);
    const Eigen::Vector3d eye_m = view.T_view_lidar.inverse().translation();
    EXPECT_NEAR(eye_m.y(), -3 * std::sin(20 * kRadPerDeg), 1e-9);
    EXPECT_NEAR(
        std::atan2(eye_m.x(), 3 - eye_m.z()) * kDegPerRad, std::copysign(35, turn_deg), 1e-9);
  }
}

/// Along the lidar's x axis.
ObliqueView ViewAhead() {
  ObliqueView view{Eigen::Isometry3d::Identity(), 640, 1.5};
  view.T_view_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return view;
}

/// The colour where the view's z axis goes.
cv::Vec3b MiddleOf(const std::vector<ColouredPoint>& points) {
  return DrawObliqueView(points, ViewAhead()).at<cv::Vec3b>(270, 360);
}

TEST(ObliqueView, ShowsWhatIsNearerInWhateverOrder) {
  std::vector<ColouredPoint> points = {{{2, 0, 0}, kRed}, {{5, 0, 0}, kBlue}, {{-2, 0, 0}, kBlue}};
  EXPECT_EQ(MiddleOf(points), kRed);
  std::reverse(points.begin(), points.end());
  EXPECT_EQ(MiddleOf(points), kRed);
}

TEST(ObliqueView, LeavesOutWhatIsNearerThanItsNearest) {
  EXPECT_EQ(MiddleOf({{{1.4, 0, 0}, kRed}, {{5, 0, 0}, kBlue}}), kBlue);
  EXPECT_EQ(MiddleOf({{{1.6, 0, 0}, kRed}, {{5, 0, 0}, kBlue}}), kRed);
}

// Patches are 38 mrad across scan lines, 24 px: the two overlap. Half-way between them is 5 mm at 2
// m, 1.6 px.
TEST(ObliqueView, GivesEachPointOfASurfaceWhatIsNearestToIt) {
  const std::vector<ColouredPoint> points = {{{2, 0, 0}, kRed}, {{2, 0, -0.01}, kBlue}};
  const cv::Mat picture = DrawObliqueView(points, ViewAhead());
  EXPECT_EQ(picture.at<cv::Vec3b>(270 - 4, 360), kRed);
  EXPECT_EQ(picture.at<cv::Vec3b>(270 + 7, 360), kBlue);
}

/// Which is chosen of samples at these distances, of those whose numbers are offered.
std::int64_t ChosenId(const std::vector<double>& distances_m,
                      const std::vector<std::size_t>& offered) {
  std::vector<BoardSample> samples(distances_m.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].id = static_cast<std::int64_t>(i);
    samples[i].lidar.pose.centre_m = {distances_m[i], 0, 0};
  }
  MedianRangeScene scene(samples);
  for (const std::size_t i : offered) scene.Offer(samples[i], cv::Mat(), PointCloud());
  return scene.Chosen() ? scene.Chosen()->sample->id : -1;
}

TEST(MedianRangeScene, IsOfTheMedianRangeWhicheverComesFirst) {
  const std::vector<double> distances_m = {9, 2, 3, 1, 2.5};
  EXPECT_EQ(ChosenId(distances_m, {0, 1, 2, 3, 4}), 4);
  EXPECT_EQ(ChosenId(distances_m, {4, 3, 2, 1, 0}), 4);
  EXPECT_EQ(ChosenId(distances_m, {0, 1, 2, 3}), 1);  // 2 and 3 m are as near: the first
  EXPECT_EQ(ChosenId(distances_m, {3, 2, 1, 0}), 1);
  EXPECT_EQ(ChosenId(distances_m, {}), -1);
}

}  // namespace
}  // namespace voqcal
