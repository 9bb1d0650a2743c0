#include "core/camera_detection/chessboard_corners.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "core/geometry/rigid.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

const BoardSpec kBoard{0.61, 0.85, 0.095, 5, 7, 0, 0};
const CameraModel kCamera = test::SmallCamera(LensModel::kPlumbBob);

// The board tilted, turned about its normal, `distance_m` ahead.
Eigen::Isometry3d BoardAhead(double roll_rad, double distance_m = 1.5) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({0.25, -0.3, 0}) * ExpSO3({M_PI, 0, 0}) * ExpSO3({0, 0, roll_rad});
  T.translation() << 0.05, -0.02, distance_m;
  return T;
}

// Farthest of the corners from where they truly are, in order.
double WorstErrorPx(const std::vector<Eigen::Vector2d>& corners_px,
                    const BoardSpec& board,
                    const Eigen::Isometry3d& T_camera_board) {
  const auto points_board_m = board.InnerCornersBoardM();
  double worst_px = corners_px.size() == points_board_m.size() ? 0 : HUGE_VAL;
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    const Eigen::Vector2d truth_px = kCamera.Project(T_camera_board * points_board_m[i]);
    worst_px = std::max(worst_px, (corners_px[i] - truth_px).norm());
  }
  return worst_px;
}

cv::Mat WithNoise(const cv::Mat& image, double sigma) {
  cv::Mat noise(image.size(), CV_16S);
  cv::RNG(5).fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::Mat noisy;
  cv::add(image, noise, noisy, cv::noArray(), CV_8U);
  return noisy;
}

// Corners of a clean rendering are off by 0.1 px or less; in a neighbour's place, by a whole square
// (10 px or more).
constexpr double kCleanPx = 0.3;
constexpr double kPoorPx = 1.5;

TEST(FindChessboardCorners, FindsCornersNearAndFarThroughBlurAndNoise) {
  for (const double distance_m : {1.2, 2.5, 4.0}) {
    const Eigen::Isometry3d T = BoardAhead(0.7, distance_m);
    const cv::Mat image = test::RenderBoard(kCamera, kBoard, T);
    const auto clean = FindChessboardCorners(image, kBoard);
    ASSERT_TRUE(clean) << distance_m << " m";
    EXPECT_LT(WorstErrorPx(*clean, kBoard, T), kCleanPx) << distance_m << " m";

    cv::Mat blurred;
    cv::GaussianBlur(image, blurred, {}, 1.5);
    const auto poor = FindChessboardCorners(WithNoise(blurred, 5), kBoard);
    ASSERT_TRUE(poor) << distance_m << " m";
    EXPECT_LT(WorstErrorPx(*poor, kBoard, T), kPoorPx) << distance_m << " m";
  }
}

TEST(FindChessboardCorners, FindsSharpUprightBoardsWhereverCornersFallBetweenPixels) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({M_PI, 0, 0});
  T.translation() << 0.1, 0.05, 1.89;  // corners at every fraction of a pixel, by the lens
  const auto found = FindChessboardCorners(test::RenderBoard(kCamera, kBoard, T), kBoard);
  ASSERT_TRUE(found);
  EXPECT_LT(WorstErrorPx(*found, kBoard, T), kCleanPx);
}

TEST(FindChessboardCorners, SurvivesBlurOfAFourthOfASquare) {
  const Eigen::Isometry3d T = BoardAhead(0.7);
  cv::Mat blurred;  // squares of 22 to 27 px
  cv::GaussianBlur(test::RenderBoard(kCamera, kBoard, T), blurred, {}, 6);
  const auto found = FindChessboardCorners(blurred, kBoard);
  ASSERT_TRUE(found);
  // Refinement then works on a quarter of the size, where corners are off by half a pixel.
  EXPECT_LT(WorstErrorPx(*found, kBoard, T), 3.0);
}

TEST(FindChessboardCorners, TakesTheQuarterTurnWhoseYPointsUp) {
  const BoardSpec square{0.8, 0.8, 0.095, 6, 6, 0, 0};
  constexpr double kRollRad = 0.3;  // within 45 degrees of upright
  for (int quarters = 0; quarters < 4; ++quarters) {
    const cv::Mat image =
        test::RenderBoard(kCamera, square, BoardAhead(kRollRad + quarters * M_PI / 2));
    const auto found = FindChessboardCorners(image, square);
    ASSERT_TRUE(found) << quarters << " quarters";
    EXPECT_LT(WorstErrorPx(*found, square, BoardAhead(kRollRad)), kCleanPx)
        << quarters << " quarters";
  }
}

TEST(FindChessboardCorners, TellsTheHalfTurnOfAnOddPatternByItsShade) {
  const BoardSpec odd{0.61, 0.85, 0.095, 5, 6, 0, 0};
  for (const double roll_rad : {0.3, 0.3 + M_PI, M_PI / 2, -M_PI / 2}) {
    const auto found =
        FindChessboardCorners(test::RenderBoard(kCamera, odd, BoardAhead(roll_rad)), odd);
    ASSERT_TRUE(found) << roll_rad;
    EXPECT_LT(WorstErrorPx(*found, odd, BoardAhead(roll_rad)), kCleanPx) << roll_rad;
  }
}

TEST(FindChessboardCorners, RefusesBoardsOfOtherSizesAndHiddenCorners) {
  const cv::Mat image = test::RenderBoard(kCamera, kBoard, BoardAhead(0.7));
  for (const auto& [num_x, num_y] : {std::pair(4, 6), {5, 6}, {4, 7}, {6, 7}, {5, 8}, {7, 9}}) {
    BoardSpec other = kBoard;
    other.num_corners_x = num_x;
    other.num_corners_y = num_y;
    EXPECT_FALSE(FindChessboardCorners(image, other)) << num_x << " x " << num_y;
  }
  const Eigen::Vector2d hidden_px =
      kCamera.Project(BoardAhead(0.7) * kBoard.InnerCornersBoardM()[8]);
  cv::Mat covered = image.clone();
  cv::circle(covered, cv::Point2d(hidden_px.x(), hidden_px.y()), 9, cv::Scalar(128), cv::FILLED);
  EXPECT_FALSE(FindChessboardCorners(covered, kBoard));
}

TEST(FindChessboardCorners, TakesImagesOfAnySize) {
  for (const auto& size : {cv::Size(1, 1), {3, 500}, {500, 3}, {7, 7}, {641, 399}}) {
    EXPECT_FALSE(FindChessboardCorners(cv::Mat(size, CV_8UC1, cv::Scalar(90)), kBoard)) << size;
  }
}

TEST(FindChessboardCorners, GivesTheSameBytesOnOneThreadAndOnTwo) {
  // Large enough for OpenCV to share out.
  cv::Mat image;
  cv::resize(WithNoise(test::RenderBoard(kCamera, kBoard, BoardAhead(0.2)), 3), image, {}, 3, 3);
  const int num_threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const auto on_one = FindChessboardCorners(image, kBoard);
  cv::setNumThreads(2);
  const auto on_two = FindChessboardCorners(image, kBoard);
  cv::setNumThreads(num_threads);
  ASSERT_TRUE(on_one && on_two);
  EXPECT_EQ(*on_one, *on_two);
}

}  // namespace
}  // namespace voqcal
