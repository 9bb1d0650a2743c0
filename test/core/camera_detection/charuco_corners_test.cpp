#include "core/camera_detection/charuco_corners.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "core/camera_detection/calibration_target.hpp"
#include "core/camera_detection/camera_board.hpp"
#include "core/geometry/rigid.hpp"
#include "support/matchers.hpp"
#include "support/spoilt_image.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

// Twice the pixels of the small camera.
const CameraModel kCamera = [] {
  CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  camera.width_px *= 2;
  camera.height_px *= 2;
  camera.fx_px *= 2;
  camera.fy_px *= 2;
  camera.cx_px *= 2;
  camera.cy_px *= 2;
  return camera;
}();

BoardSpec Charuco() {
  BoardSpec board{0.61, 0.85, 0.095, 5, 7, 0.002, 0};
  board.pattern = "charuco";
  board.dictionary = "5x5_100";
  board.marker_m = 0.07;
  return board;
}

// The board 1.2 m ahead: squares of about 65 px.
Eigen::Isometry3d BoardAhead(double roll_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({0.2, -0.25, 0}) * ExpSO3({M_PI, 0, 0}) * ExpSO3({0, 0, roll_rad});
  T.translation() << 0.02, -0.01, 1.2;
  return T;
}

Expected<CameraBoard, CameraBoardMiss> Detect(const cv::Mat& image, const BoardSpec& board) {
  return DetectCameraBoard(image, kCamera, board, {});
}

std::size_t NumSeen(const CameraBoard& board) {
  return std::count_if(board.corners_px.begin(), board.corners_px.end(), [](const auto& corner) {
    return corner.allFinite();
  });
}

// Corners of a clean rendering are off by about 0.1 px of 840 at 1.2 m: 0.15 mm across, and half a
// millimetre in depth, 0.1 / 270 px x 1.2 m; tilts 0.1 / 65 px a square / sqrt(35). Allow 4 x, as
// markers' edges pull at the corners.
constexpr double kRotationTolerance = 2e-3;
constexpr double kTranslationToleranceM = 2e-3;

TEST(DetectCharuco, FindsTheWholeBoardEitherWayUp) {
  for (const double roll_rad : {0.1, M_PI / 2, M_PI + 0.1, -M_PI / 2}) {
    const auto found =
        Detect(test::RenderBoard(kCamera, Charuco(), BoardAhead(roll_rad)), Charuco());
    ASSERT_TRUE(found) << roll_rad << ": " << found.error().detail;
    EXPECT_THAT(TransformFromPose(found->pose),
                test::IsNear(BoardAhead(roll_rad), kRotationTolerance, kTranslationToleranceM));
    EXPECT_GE(NumSeen(*found), 30u) << roll_rad;  // the image's height cuts some of them off
  }
}

TEST(DetectCharuco, FindsABoardOfWhichHalfIsHidden) {
  const cv::Mat whole = test::RenderBoard(kCamera, Charuco(), BoardAhead(0.1));
  const cv::Mat left = whole.clone();
  left.colRange(whole.cols / 2, whole.cols).setTo(110);
  const auto found = Detect(left, Charuco());
  ASSERT_TRUE(found) << found.error().detail;
  EXPECT_GT(NumSeen(*found), 10u);
  EXPECT_LT(NumSeen(*found), 25u);
  // Half of the corners over half of the width: 3 x the error.
  EXPECT_THAT(TransformFromPose(found->pose),
              test::IsNear(BoardAhead(0.1), 3 * kRotationTolerance, 3 * kTranslationToleranceM));
  const std::vector<Eigen::Vector3d> points_board_m = Charuco().InnerCornersBoardM();
  for (std::size_t k = 0; k < points_board_m.size(); ++k) {
    const Eigen::Vector2d corner_px = found->corners_px[k];
    if (!corner_px.allFinite()) continue;
    const Eigen::Vector2d truth_px = kCamera.Project(BoardAhead(0.1) * points_board_m[k]);
    EXPECT_LT((corner_px - truth_px).norm(), 0.5) << k;
  }
}

TEST(DetectCharuco, RefusesAnotherDictionaryWithTheReason) {
  const cv::Mat image = test::RenderBoard(kCamera, Charuco(), BoardAhead(0.1));
  BoardSpec other = Charuco();
  other.dictionary = "4x4_50";
  const auto found = Detect(image, other);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().fault, CameraBoardFault::kNoBoard);
  EXPECT_THAT(found.error().detail, HasSubstr(" dark squares is a marker of 4x4_50"));
}

TEST(DetectCharuco, RefusesAFewCornersAndNone) {
  const cv::Mat image = test::RenderBoard(kCamera, Charuco(), BoardAhead(0.1));
  cv::Mat strip(image.size(), image.type(), cv::Scalar(110));
  const cv::Rect middle(image.cols / 2 - 80, image.rows / 2 - 80, 160, 160);
  image(middle).copyTo(strip(middle));
  const auto few = Detect(strip, Charuco());
  ASSERT_FALSE(few);
  EXPECT_THAT(few.error().detail, HasSubstr("arker"));
  const auto none = Detect(cv::Mat(image.size(), CV_8UC1, cv::Scalar(90)), Charuco());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().detail, "none of 0 dark squares is a marker of 5x5_100");
}

TEST(DetectCharuco, WarnsOfBlurAndOfGlare) {
  const cv::Mat image = test::RenderBoard(kCamera, Charuco(), BoardAhead(0.1));
  const auto reasons = [](const Expected<CameraBoard, CameraBoardMiss>& found) {
    std::string text;
    if (!found) return "miss: " + found.error().detail;
    for (const auto& warning : found->warnings) text += warning.reason + " ";
    return text;
  };
  EXPECT_THAT(reasons(Detect(test::Blurred(image, 2), Charuco())), HasSubstr("blurred"));
  const Eigen::Vector2d centre_px = kCamera.Project(BoardAhead(0.1).translation().eval());
  EXPECT_THAT(reasons(Detect(test::WithGlare(image, centre_px, 60, 130), Charuco())),
              HasSubstr("glare"));
}

TEST(BoardSpecCharuco, SaysWhatIsWrong) {
  BoardSpec board = Charuco();
  EXPECT_THAT(BoardProblems(board), ::testing::IsEmpty());
  board.dictionary = "5x5";
  EXPECT_THAT(BoardProblems(board).at(0), HasSubstr("dictionary must be a name"));
  board.dictionary = "apriltag_16h5";  // 30 markers, and the board has 24 white squares
  board.marker_m = 0.1;
  EXPECT_THAT(BoardProblems(board).at(0), HasSubstr("marker_m must be above 0 and below square_m"));
  board.marker_m = 0.07;
  board.num_corners_x = 8;
  board.num_corners_y = 8;
  board.square_m = 0.06;
  board.marker_m = 0.05;
  EXPECT_THAT(BoardProblems(board).at(0), HasSubstr("must have a marker for each white square"));
}

}  // namespace
}  // namespace voqcal
