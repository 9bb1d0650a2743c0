#include "report/overlays.hpp"

#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

/// The picture of a sample whose board the camera would have at `centre_camera_m`.
cv::Mat PictureOfBoardAt(const Eigen::Vector3d& centre_camera_m) {
  BoardSample sample = test::SynthesizeSamples({}).front();
  const Eigen::Vector3d step_m = centre_camera_m - sample.camera.pose.centre_m;
  sample.camera.pose.centre_m += step_m;
  for (Eigen::Vector3d& corner_m : sample.camera.pose.corners_m) corner_m += step_m;
  const CameraModel camera = test::TestCamera();
  const cv::Mat image(camera.height_px, camera.width_px, CV_8UC1, cv::Scalar(90));
  return DrawBoard({sample, image, PointCloud{}}, camera, test::TestExtrinsic());
}

// Floats beyond what an integer holds become none: the sanitizer of casts would tell.
TEST(DrawBoard, HasNoPictureOfABoardThatIsNotInTheView) {
  EXPECT_FALSE(PictureOfBoardAt({0, 0, 3}).empty());
  EXPECT_TRUE(PictureOfBoardAt({0, 0, -3}).empty());
  EXPECT_TRUE(PictureOfBoardAt({1e6, 0, 3}).empty());
}

TEST(RangeColour, IsRedNearAndBlueFarAsOnTheDashboard) {
  const cv::Vec3b near = RangeColourBgr(1.5);
  const cv::Vec3b far = RangeColourBgr(20);
  EXPECT_GT(near[2], near[0]);
  EXPECT_GT(far[0], far[2]);
  EXPECT_EQ(RangeColourBgr(0.1), RangeColourBgr(kNearRangeM));
  EXPECT_EQ(RangeColourBgr(1e3), RangeColourBgr(kFarRangeM));
}

}  // namespace
}  // namespace voqcal
