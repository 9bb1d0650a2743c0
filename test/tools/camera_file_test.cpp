#include "draft_rig/camera_file.hpp"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class ReadCamera : public ::testing::Test {
 protected:
  CameraModel Read(const std::string& text) const {
    return ReadCameraFile(folder_.Write("camera.yaml", text));
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReadCamera, TakesRosFilesAlsoWithTheLineThatOpenCvPutsFirst) {
  const CameraModel camera = Read(
      "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"
      "camera_matrix: !!opencv-matrix {rows: 3, cols: 3, dt: d, data: [500, 0, 320, 0, 501, 240, "
      "0, 0, 1]}\n"
      "distortion_coefficients: {rows: 1, cols: 5, data: [-0.1, 0.2, 0.001, 0.002, 0]}\n");
  EXPECT_EQ(camera.lens, LensModel::kPlumbBob);
  EXPECT_EQ(camera.height_px, 480);
  EXPECT_EQ(camera.fy_px, 501);
  EXPECT_EQ(camera.cx_px, 320);
  EXPECT_EQ(camera.distortion[3], 0.002);
}

TEST_F(ReadCamera, TakesCamLidarCalibrationsFilesAndIgnoresZerosTooMany) {
  const CameraModel camera = Read(
      "distortion_model: \"fisheye\"\nwidth: 1920\nheight: 1208\nD: [-0.05, -0.07, 0.09, -0.05, "
      "0]\n"
      "K: [1176.9, 0.0, 962.2, 0.0, 1177.7, 612.7, 0.0, 0.0, 1.0]\n");
  EXPECT_EQ(camera.lens, LensModel::kEquidistant);
  EXPECT_EQ(camera.width_px, 1920);
  EXPECT_EQ(camera.cy_px, 612.7);
  EXPECT_EQ(camera.distortion[2], 0.09);
}

TEST_F(ReadCamera, TakesTheSectionOfARigFile) {
  const std::string keys =
      "{lens_model: plumb_bob, width_px: 64, height_px: 48, fx_px: 50, fy_px: 51, cx_px: 32, "
      "cy_px: 24, distortion: [0, 0, 0, 0, 0]}";
  EXPECT_EQ(Read("camera: " + keys).fy_px, 51);
  EXPECT_EQ(Read(keys).fy_px, 51);
}

TEST_F(ReadCamera, NamesEachKeyThatIsMissingOrWrong) {
  EXPECT_THAT([&] { Read("width: x\nK: [1, 2]\nD: [0.1, 0, 0, 0, 0, 0.3]\n"); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("camera.yaml"),
                                                      HasSubstr("height is missing"),
                                                      HasSubstr("width must be a whole number"),
                                                      HasSubstr("K must have 9 numbers"),
                                                      HasSubstr("D has more coefficients"))));
}

}  // namespace
}  // namespace voqcal
