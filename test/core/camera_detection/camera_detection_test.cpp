// Wherever OpenCV's finders find the board, ours does. `voqcal_figures camera-detection` does the
// same with larger images and more of them.

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "core/camera_detection/camera_board.hpp"
#include "support/camera_scenes.hpp"
#include "support/test_cameras.hpp"

namespace voqcal {
namespace {

constexpr std::uint32_t kNumImages = 4;  // of each kind

class CameraDetection : public ::testing::TestWithParam<std::string> {};

TEST_P(CameraDetection, FindsWhatOpenCvFinds) {
  const CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
  const BoardSpec board = test::TestBoard();
  const cv::Size pattern(board.num_corners_x, board.num_corners_y);
  for (std::uint32_t seed = 1; seed <= kNumImages; ++seed) {
    const test::CameraScene scene = test::MakeCameraScene(GetParam(), camera, board, seed);
    std::vector<cv::Point2f> theirs;
    const bool is_theirs = cv::findChessboardCornersSB(scene.image, pattern, theirs) ||
                           cv::findChessboardCorners(scene.image, pattern, theirs);
    const auto ours = DetectCameraBoard(scene.image, camera, board, {});
    if (ours) {
      EXPECT_TRUE(test::AreTheCorners(ours->corners_px, camera, board, scene.T_camera_board))
          << seed;
    } else if (is_theirs) {
      ADD_FAILURE() << "seed " << seed << ": " << ToString(ours.error().fault) << ": "
                    << ours.error().detail;
    }
  }
}

std::string NameOf(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  return name;
}
INSTANTIATE_TEST_SUITE_P(Kinds,
                         CameraDetection,
                         ::testing::ValuesIn(test::kCameraSceneKinds),
                         NameOf);

}  // namespace
}  // namespace voqcal
