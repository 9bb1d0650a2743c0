#include "core/camera_detection/camera_board.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "support/matchers.hpp"
#include "support/real_data.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

const BoardSpec kBoard{0.61, 0.85, 0.095, 5, 7, 0.002, 0};

// The board 1.5 m ahead, y up in the image, turned by `roll_rad` about its normal and tilted.
Eigen::Isometry3d BoardAhead(double roll_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = ExpSO3({0.25, -0.3, 0}) * ExpSO3({M_PI, 0, 0}) * ExpSO3({0, 0, roll_rad});
  T.translation() << 0.05, -0.02, 1.5;
  return T;
}

// Corners of a noise-free rendering are off by about 0.1 px. At 420 px and 1.5 m that is 0.1 / 420
// x 1.5 = 0.4 mm across, and the depth follows from the pattern's 160 px: 0.1 / 160 x 1.5 m = 1 mm;
// tilts about 0.1 / 27 px a square / sqrt(35) = 0.6 mrad. Allow 3 x.
constexpr double kRotationTolerance = 3e-3;
constexpr double kTranslationToleranceM = 3e-3;

TEST(DetectCameraBoard, FindsARenderedBoardThroughEachLens) {
  for (const LensModel lens : test::kLenses) {
    const CameraModel camera = test::SmallCamera(lens);
    const cv::Mat image = test::RenderBoard(camera, kBoard, BoardAhead(0.5));
    const auto found = DetectCameraBoard(image, camera, kBoard, {});
    ASSERT_TRUE(found) << ToString(lens) << ": " << ToString(found.error().fault);
    EXPECT_THAT(TransformFromPose(found->pose),
                test::IsNear(BoardAhead(0.5), kRotationTolerance, kTranslationToleranceM));
    EXPECT_LT(found->reprojection_rms_px, 0.2);
    EXPECT_EQ(found->corners_px.size(), 35u);
  }
}

TEST(DetectCameraBoard, TakesTheHalfTurnWhoseYPointsUp) {
  const CameraModel camera = test::SmallCamera(LensModel::kRational);
  BoardSpec board = kBoard;
  board.pattern_offset_x_m = 0;  // else the half turn would show
  const cv::Mat image = test::RenderBoard(camera, board, BoardAhead(0.5 + M_PI));
  const auto found = DetectCameraBoard(image, camera, board, {});
  ASSERT_TRUE(found);
  EXPECT_THAT(TransformFromPose(found->pose),
              test::IsNear(BoardAhead(0.5), kRotationTolerance, kTranslationToleranceM));
}

std::optional<CameraBoardFault> FaultOf(const cv::Mat& image,
                                        const CameraModel& camera,
                                        const CameraBoardOptions& options) {
  const auto found = DetectCameraBoard(image, camera, kBoard, options);
  if (found) return {};
  return found.error().fault;
}

TEST(DetectCameraBoard, SaysWhyThereIsNoBoard) {
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  const cv::Mat plain(camera.height_px, camera.width_px, CV_8UC3, cv::Scalar::all(90));
  EXPECT_EQ(FaultOf(plain, camera, {}), CameraBoardFault::kNoBoard);
  cv::Mat noise(camera.height_px, camera.width_px, CV_8UC1);
  cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 0, 256);
  EXPECT_EQ(FaultOf(noise, camera, {}), CameraBoardFault::kNoBoard);

  const cv::Mat image = test::RenderBoard(camera, kBoard, BoardAhead(0));
  CameraBoardOptions strict;
  strict.max_reprojection_rms_px = 1e-6;
  EXPECT_EQ(FaultOf(image, camera, strict), CameraBoardFault::kPoorFit);
  CameraModel folded = camera;  // every pixel of the board lies beyond the largest distorted radius
  folded.distortion = {-1000};
  EXPECT_EQ(FaultOf(image, folded, {}), CameraBoardFault::kNoPose);
}

TEST(DetectCameraBoard, RefusesImagesThatAreNotTheCameras) {
  const CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  const auto message = [&](const cv::Mat& image, const CameraBoardOptions& options) -> std::string {
    try {
      (void)DetectCameraBoard(image, camera, kBoard, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message(cv::Mat(100, 200, CV_8UC1), {}),
              testing::AllOf(testing::HasSubstr("200 x 100"), testing::HasSubstr("640 x 400")));
  EXPECT_THAT(message(cv::Mat(400, 640, CV_16UC1), {}), testing::HasSubstr("16 bits"));
  EXPECT_THAT(message(cv::Mat(), {}), testing::HasSubstr("0 x 0"));
  CameraBoardOptions bad;
  bad.max_reprojection_rms_px = -2;
  EXPECT_THAT(message(cv::Mat(400, 640, CV_8UC1), bad),
              testing::HasSubstr("max_reprojection_rms_px must be positive and finite, is -2"));
}

TEST(DetectCameraBoard, RefusesCamerasAndBoardsThatCannotBe) {
  const cv::Mat image(400, 640, CV_8UC1, cv::Scalar(90));
  const auto message = [&](const CameraModel& camera, const BoardSpec& board) -> std::string {
    try {
      (void)DetectCameraBoard(image, camera, board, {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CameraModel camera = test::SmallCamera(LensModel::kPlumbBob);
  camera.fx_px = -3;
  EXPECT_THAT(message(camera, kBoard),
              testing::AllOf(testing::HasSubstr("DetectCameraBoard: camera: "),
                             testing::HasSubstr("fx_px"),
                             testing::HasSubstr("-3")));
  BoardSpec board = kBoard;
  board.square_m = 0;
  board.num_corners_x = 1;
  EXPECT_THAT(message(test::SmallCamera(LensModel::kPlumbBob), board),
              testing::AllOf(testing::HasSubstr("DetectCameraBoard: board: "),
                             testing::HasSubstr("square_m"),
                             testing::HasSubstr("num_corners_x")));
}

TEST(DetectCameraBoard, FindsEveryBoardOfTheRealSession) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  int num_images = 0;
  double rms_sum_px = 0;
  for (int pose = 1; pose <= 40; ++pose) {
    const auto file = *data / "acfr-vlp16/images" / ("pose" + std::to_string(pose) + ".png");
    if (!std::filesystem::exists(file)) continue;
    ++num_images;
    const cv::Mat image = cv::imread(file.string());
    const auto found = DetectCameraBoard(image, test::RealCamera(), kBoard, {});
    ASSERT_TRUE(found) << file << ": " << ToString(found.error().fault);
    EXPECT_LT(found->reprojection_rms_px, 0.5) << file;
    rms_sum_px += found->reprojection_rms_px;
    const auto& corners = found->pose.corners_m;
    EXPECT_LT(corners[3].y(), corners[0].y()) << file;  // board y up
    EXPECT_LT(found->pose.normal.z(), 0) << file;
  }
  EXPECT_EQ(num_images, 30);
  EXPECT_LT(rms_sum_px / 30, 0.17);  // what corners at full size reach (0.161), and no less
}

}  // namespace
}  // namespace voqcal
