#include "import/camera_file.hpp"

#include <array>
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

// As kalibr_calibrate_cameras writes it.
const std::string kCamchain =
    "cam0:\n"
    "  cam_overlaps: [1]\n"
    "  camera_model: pinhole\n"
    "  distortion_coeffs: [-0.28, 0.07, 0.0002, -0.0001]\n"
    "  distortion_model: radtan\n"
    "  intrinsics: [458.6, 457.2, 367.2, 248.3]\n"
    "  resolution: [752, 480]\n"
    "  rostopic: /cam0/image_raw\n"
    "cam1:\n"
    "  T_cn_cnm1:\n"
    "  - [1.0, 0.0, 0.0, -0.11]\n"
    "  - [0.0, 1.0, 0.0, 0.0]\n"
    "  - [0.0, 0.0, 1.0, 0.0]\n"
    "  - [0.0, 0.0, 0.0, 1.0]\n"
    "  camera_model: pinhole\n"
    "  distortion_coeffs: [0.01, 0.02, 0.03, 0.04]\n"
    "  distortion_model: equidistant\n"
    "  intrinsics: [457.5, 456.1, 379.9, 255.2]\n"
    "  resolution: [752, 480]\n";

// As camera_calibration writes it.
const std::string kCameraInfo =
    "image_width: 1280\n"
    "image_height: 720\n"
    "camera_name: front\n"
    "camera_matrix:\n"
    "  rows: 3\n"
    "  cols: 3\n"
    "  data: [900.0, 0.0, 640.0, 0.0, 901.0, 360.0, 0.0, 0.0, 1.0]\n"
    "distortion_model: plumb_bob\n"
    "distortion_coefficients:\n"
    "  rows: 1\n"
    "  cols: 5\n"
    "  data: [-0.4, 0.2, -0.001, 0.0002, -0.07]\n";

class CameraFile : public ::testing::Test {
 protected:
  CameraModel Read(const std::string& text, const std::string& name = "") const {
    return ReadCameraFile(folder_.Write("camera.yaml", text), name);
  }

  std::string ErrorOf(const std::string& text, const std::string& name = "") const {
    try {
      Read(text, name);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  static std::string Replaced(std::string text, const std::string& old, const std::string& with) {
    return text.replace(text.find(old), old.size(), with);
  }

  test::TemporaryFolder folder_;
};

TEST_F(CameraFile, OfKalibrHasEachOfItsCameras) {
  const CameraModel first = Read(kCamchain);
  EXPECT_EQ(first.lens, LensModel::kPlumbBob);
  EXPECT_EQ(first.distortion, (std::array<double, 8>{-0.28, 0.07, 0.0002, -0.0001}));
  EXPECT_EQ(first.width_px, 752);
  EXPECT_EQ(first.height_px, 480);
  EXPECT_EQ(first.fx_px, 458.6);
  EXPECT_EQ(first.cy_px, 248.3);
  const CameraModel second = Read(kCamchain, "cam1");
  EXPECT_EQ(second.lens, LensModel::kEquidistant);
  EXPECT_EQ(second.fx_px, 457.5);
}

TEST_F(CameraFile, OfRosHasItsCamera) {
  const CameraModel camera = Read(kCameraInfo);
  EXPECT_EQ(camera.lens, LensModel::kPlumbBob);
  EXPECT_EQ(camera.distortion, (std::array<double, 8>{-0.4, 0.2, -0.001, 0.0002, -0.07}));
  EXPECT_EQ(camera.width_px, 1280);
  EXPECT_EQ(camera.fy_px, 901.0);
  EXPECT_EQ(camera.cx_px, 640.0);
}

TEST_F(CameraFile, OfAnotherLensSaysHowToConvertIt) {
  EXPECT_THAT(ErrorOf(Replaced(kCamchain, "pinhole", "omni")),
              HasSubstr("camera.yaml:3: cam0.camera_model must be pinhole (calibrate again by "
                        "--models pinhole-radtan, or pinhole-equi for a fisheye), is \"omni\""));
  EXPECT_THAT(ErrorOf(Replaced(kCamchain, "radtan", "fov")),
              HasSubstr("camera.yaml:5: cam0.distortion_model must be equidistant, plumb_bob"));
}

TEST_F(CameraFile, SaysWhatItLacks) {
  EXPECT_THAT(ErrorOf(kCamchain, "cam2"), HasSubstr("cam2 is missing"));
  EXPECT_THAT(ErrorOf("cam0: {}\n"), HasSubstr("cam0.intrinsics is missing"));
  EXPECT_THAT(ErrorOf(Replaced(kCamchain, "458.6, ", "")),
              HasSubstr("cam0.intrinsics must be a list of 4, is a list of 3"));
  EXPECT_THAT(ErrorOf(Replaced(kCameraInfo, "900.0", "0")), HasSubstr("fx_px"));
}

TEST_F(CameraFile, TakesRosFilesAlsoWithTheLineThatOpenCvPutsFirst) {
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

TEST_F(CameraFile, TakesCamLidarCalibrationsFilesAndIgnoresZerosTooMany) {
  const CameraModel camera = Read(
      "distortion_model: \"fisheye\"\nwidth: 1920\nheight: 1208\nD: [-0.05, -0.07, 0.09, -0.05, "
      "0]\n"
      "K: [1176.9, 0.0, 962.2, 0.0, 1177.7, 612.7, 0.0, 0.0, 1.0]\n");
  EXPECT_EQ(camera.lens, LensModel::kEquidistant);
  EXPECT_EQ(camera.width_px, 1920);
  EXPECT_EQ(camera.cy_px, 612.7);
  EXPECT_EQ(camera.distortion[2], 0.09);
}

TEST_F(CameraFile, TakesTheSectionOfARigFile) {
  const std::string keys =
      "{lens_model: plumb_bob, width_px: 64, height_px: 48, fx_px: 50, fy_px: 51, cx_px: 32, "
      "cy_px: 24, distortion: [0, 0, 0, 0, 0]}";
  EXPECT_EQ(Read("camera: " + keys).fy_px, 51);
  EXPECT_EQ(Read(keys).fy_px, 51);
}

TEST_F(CameraFile, NamesEachKeyThatIsMissingOrWrong) {
  EXPECT_THAT([&] { Read("width: x\nK: [1, 2]\nD: [0.1, 0, 0, 0, 0, 0.3]\n"); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("camera.yaml"),
                                                      HasSubstr("height is missing"),
                                                      HasSubstr("width must be a whole number"),
                                                      HasSubstr("K must be a list of 9"))));
}

}  // namespace
}  // namespace voqcal
