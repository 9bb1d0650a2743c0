#include "core/lens_calibration/lens_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/spoilt_image.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/synthetic_lens_views.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

const CameraModel kCamera = test::SmallCamera(LensModel::kPlumbBob);
const cv::Size kImagePx(kCamera.width_px, kCamera.height_px);

std::vector<LensView> Stills(int num_views) {
  test::LensViewsOptions options;
  options.num_views = num_views;
  return test::MakeLensViews(kCamera, options);
}

LensView Moved(const LensView& view, double by_px, std::int64_t by_us) {
  LensView moved = view;
  moved.utime += by_us;
  for (Eigen::Vector2d& corner_px : moved.corners_px) corner_px.x() += by_px;
  return moved;
}

ViewChoice Choose(const std::vector<LensView>& views, const ViewChoiceOptions& options = {}) {
  return ChooseViews(views, test::TestBoard(), kImagePx, options);
}

TEST(ChooseViews, TakesEachPoseOnce) {
  std::vector<LensView> views = Stills(6);
  views.push_back(Moved(views[2], 0.5, 60'000'000));
  LensView turned = Moved(views[3], 0, 70'000'000);  // the finder began at the other end
  std::reverse(turned.corners_px.begin(), turned.corners_px.end());
  views.push_back(turned);
  const ViewChoice choice = Choose(views);
  EXPECT_EQ(choice.views.size(), 6U);
  EXPECT_EQ(choice.num_repeated, 2U);
  EXPECT_EQ(choice.num_moving + choice.num_blurred + choice.num_beyond, 0U);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_LT(choice.views[i - 1].utime, choice.views[i].utime);
  }
}

// A video: three frames at rest at each place, and two on the way to it.
TEST(ChooseViews, LeavesOutWhatMovesInAVideo) {
  std::vector<LensView> video;
  for (const LensView& still : Stills(6)) {
    for (const double by_px : {-9.0, -4.0, 0.0, 0.1, 0.2}) {
      video.push_back(Moved(still, by_px, 50'000 * static_cast<int>(video.size() % 5)));
    }
  }
  const ViewChoice choice = Choose(video);
  EXPECT_EQ(choice.views.size(), 6U);
  EXPECT_EQ(choice.num_moving, 12U);
  EXPECT_EQ(choice.num_repeated, 12U);
}

// Numbered files have times too, a tenth of a second apart, but nothing moved between them.
TEST(ChooseViews, TakesStillsAsResting) {
  std::vector<LensView> views = Stills(8);
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].utime = static_cast<std::int64_t>(i) * 100'000;
  }
  EXPECT_EQ(Choose(views).views.size(), 8U);
}

TEST(ChooseViews, LeavesOutWhatIsBlurredMoreThanMost) {
  std::vector<LensView> views = Stills(8);
  for (LensView& view : views) view.edge_width_px = 2;
  views[5].edge_width_px = 5;
  views[6].edge_width_px = 2.9;  // sharp enough
  const ViewChoice choice = Choose(views);
  EXPECT_EQ(choice.num_blurred, 1U);
  EXPECT_EQ(choice.views.size(), 7U);
}

TEST(ChooseViews, TakesTheMostDifferentWhereThereAreMany) {
  ViewChoiceOptions few;
  few.max_views = 5;
  const ViewChoice choice = Choose(Stills(12), few);
  EXPECT_EQ(choice.views.size(), 5U);
  EXPECT_EQ(choice.num_beyond, 7U);
}

TEST(SeeLensView, FindsCornersAndTheirSharpnessWithoutALens) {
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.linear() = ExpSO3({M_PI, 0, 0}) * ExpSO3({0.2, 0.3, 0});
  T_camera_board.translation() << 0.1, 0.05, 1.6;
  const cv::Mat image = test::RenderBoard(kCamera, test::TestBoard(), T_camera_board);
  const auto sharp = SeeLensView(image, test::TestBoard(), 7);
  ASSERT_TRUE(sharp);
  EXPECT_EQ(sharp->utime, 7);
  EXPECT_EQ(NumCorners(*sharp), 35U);
  EXPECT_LT(sharp->edge_width_px, 2.5);
  const auto blurred = SeeLensView(test::Blurred(image, 2), test::TestBoard(), 7);
  ASSERT_TRUE(blurred);
  EXPECT_GT(blurred->edge_width_px, 4);  // 2.563 sigma

  const auto nothing =
      SeeLensView(cv::Mat(400, 640, CV_8UC1, cv::Scalar(90)), test::TestBoard(), 7);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().fault, CameraBoardFault::kNoBoard);
}

TEST(SeeLensView, TakesAPartOfABoardWithMarkers) {
  BoardSpec board = test::TestBoard();
  board.pattern = "charuco";
  board.marker_m = 0.07;
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.linear() = ExpSO3({M_PI, 0, 0}) * ExpSO3({0.2, 0.3, 0});
  T_camera_board.translation() << 0.55, 0, 0.8;  // beyond the image's right border
  const cv::Mat image = test::RenderBoard(kCamera, board, T_camera_board);
  const auto part = SeeLensView(image, board, 7);
  ASSERT_TRUE(part) << part.error().detail;
  EXPECT_GE(NumCorners(*part), 12U);
  EXPECT_LT(NumCorners(*part), 35U);
}

}  // namespace
}  // namespace voqcal
