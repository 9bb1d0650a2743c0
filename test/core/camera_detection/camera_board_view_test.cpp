// What the camera board detector says of poor views: blur, glare, boards cut off, small or hidden.

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "core/camera_detection/camera_board.hpp"
#include "core/geometry/rigid.hpp"
#include "support/matchers.hpp"
#include "support/spoilt_image.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const BoardSpec kBoard{0.61, 0.85, 0.095, 5, 7, 0, 0};
const CameraModel kCamera = test::SmallCamera(LensModel::kPlumbBob);

// Squares of 22 to 27 px at 1.5 m.
Eigen::Isometry3d BoardAhead(double x_m = 0.05, double distance_m = 1.5) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({0.25, -0.3, 0}) * ExpSO3({M_PI, 0, 0}) * ExpSO3({0, 0, 0.2});
  T.translation() << x_m, -0.02, distance_m;
  return T;
}

cv::Mat Image(const Eigen::Isometry3d& T = BoardAhead()) {
  return test::RenderBoard(kCamera, kBoard, T);
}

Eigen::Vector2d CornerPx(std::size_t k) {
  return kCamera.Project(BoardAhead() * kBoard.InnerCornersBoardM()[k]);
}

Expected<CameraBoard, CameraBoardMiss> Detect(const cv::Mat& image) {
  return DetectCameraBoard(image, kCamera, kBoard, {});
}

// "blurred: edge width ...", one after the other; for a miss "miss: cut off: ...".
std::string Remarks(const Expected<CameraBoard, CameraBoardMiss>& found) {
  if (!found) return "miss: " + ToString(found.error().fault) + ": " + found.error().detail;
  std::string text;
  for (const auto& warning : found->warnings) text += warning.reason + ": " + warning.detail + "\n";
  return text;
}

// The number after `label`.
double NumberAfter(const std::string& text, const std::string& label) {
  const auto at = text.find(label);
  return at == std::string::npos ? std::nan("") : std::atof(text.c_str() + at + label.size());
}

TEST(CameraBoardView, AGoodViewHasNoWarning) {
  EXPECT_EQ(Remarks(Detect(Image())), "");
  EXPECT_EQ(Remarks(Detect(test::WithNoise(Image(), 5, 1))), "");
}

TEST(CameraBoardView, BlurIsAWarningWithTheEdgesWidth) {
  for (const double sigma_px : {1.5, 2.0, 3.0}) {
    const std::string remarks = Remarks(Detect(test::Blurred(Image(), sigma_px)));
    EXPECT_THAT(remarks, HasSubstr("blurred: edge width"));
    // 10 % to 90 % of a Gaussian's step, and 0.3 px rms of the pixel itself; the line across sees
    // the squares' other edges too.
    const double expected_px = 2.563 * std::hypot(sigma_px, 0.3);
    EXPECT_NEAR(NumberAfter(remarks, "edge width "), expected_px, 0.15 * expected_px);
  }
}

TEST(CameraBoardView, MotionInOneDirectionIsBlur) {
  EXPECT_THAT(Remarks(Detect(test::MovedAlongRows(Image(), 7))), HasSubstr("blurred: edge width"));
}

TEST(CameraBoardView, EdgesThatRunIntoEachOtherAreAMiss) {
  CameraBoardOptions options;
  options.max_edge_width_squares = 0.5;
  const auto found = DetectCameraBoard(test::Blurred(Image(), 5.5), kCamera, kBoard, options);
  EXPECT_THAT(Remarks(found), HasSubstr("miss: blurred: edge width"));
}

TEST(CameraBoardView, PaleCornersAreGlareAndShadowIsNot) {
  const std::string remarks = Remarks(Detect(test::WithGlare(Image(), CornerPx(17), 40, 130)));
  EXPECT_THAT(remarks, HasSubstr("glare: a corner's contrast is 0."));
  const Eigen::Vector2d along(0.3, 1);
  EXPECT_EQ(Remarks(Detect(test::WithShadow(Image(), CornerPx(17), along, 0.4, 3))), "");
  EXPECT_EQ(Remarks(Detect(test::UnevenlyLit(Image(), 0.3))), "");
  EXPECT_EQ(Remarks(Detect(test::Paled(Image(), 0.2, 30))), "");  // contrast of 38 grey levels
}

TEST(CameraBoardView, CornersLostInWhiteAreAMissByGlare) {
  const cv::Mat image = test::WithGlare(Image(), CornerPx(16), 20, 500);
  EXPECT_THAT(Remarks(Detect(image)), HasSubstr("miss: glare: "));
}

TEST(CameraBoardView, ABoardCutOffIsAWarningWhileItsCornersAreSeen) {
  // Moved to the right until something of it is 8 px beyond the border.
  const auto moved_until_outside = [](const auto& points_board_m) {
    for (double x_m = 0.5;; x_m += 0.01) {
      for (const Eigen::Vector3d& point_m : points_board_m) {
        if (kCamera.Project(BoardAhead(x_m) * point_m).x() > kCamera.width_px + 8) return x_m;
      }
    }
  };
  const auto outline_cut = Detect(Image(BoardAhead(moved_until_outside(kBoard.OutlineBoardM()))));
  EXPECT_THAT(Remarks(outline_cut), ::testing::StartsWith("cut off: outside the image lie "));
  const std::string corners_cut =
      Remarks(Detect(Image(BoardAhead(moved_until_outside(kBoard.InnerCornersBoardM())))));
  EXPECT_THAT(corners_cut, HasSubstr("miss: cut off: "));
  EXPECT_THAT(corners_cut, HasSubstr(" of 35 corners, the next ones beyond the image's border"));
}

TEST(CameraBoardView, SmallSquaresAreAWarning) {
  const std::string remarks = Remarks(Detect(Image(BoardAhead(0.05, 5))));
  EXPECT_THAT(remarks, HasSubstr("too small: squares of "));
  // 0.095 m at 5 m, seen by 420 px of focal length, and 0.4 rad of tilt at most.
  EXPECT_NEAR(NumberAfter(remarks, "squares of "), 0.095 / 5 * 420 * std::cos(0.35), 0.5);
}

TEST(CameraBoardView, AHiddenCornerIsAMissWithTheirNumber) {
  cv::Mat image = Image();
  cv::circle(image, cv::Point2d(CornerPx(17).x(), CornerPx(17).y()), 9, cv::Scalar(90), cv::FILLED);
  EXPECT_EQ(Remarks(Detect(image)), "miss: partly hidden: 34 of 35 corners");
}

TEST(CameraBoardView, OptionsSayWhatIsWrongWithThem) {
  CameraBoardOptions options;
  options.max_edge_width_rad = 0;
  options.max_edge_width_squares = -1;
  options.min_square_px = -2;
  options.min_contrast = 1.5;
  options.max_outside_share = -0.1;
  options.max_mirrored_probability = 2;
  EXPECT_THAT(options.Problems(),
              ::testing::ElementsAre("max_edge_width_rad must be positive and finite, is 0",
                                     "max_edge_width_squares must be positive and finite, is -1",
                                     "min_square_px must not be negative, is -2",
                                     "min_contrast must be 0 to 1, is 1.5",
                                     "max_outside_share must be 0 to 1, is -0.1",
                                     "max_mirrored_probability must be 0 to 1, is 2"));
}

}  // namespace
}  // namespace voqcal
