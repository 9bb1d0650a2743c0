#include "rig/rig_doubts.hpp"

#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rig/default_rig.hpp"
#include "rig/frame_pairing.hpp"
#include "rig/listening_address.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

BoardSpec UsualBoard() {
  BoardSpec board;
  board.width_m = 0.767;
  board.height_m = 0.626;
  board.square_m = 0.07;
  board.num_corners_x = 8;
  board.num_corners_y = 6;
  return board;
}

CameraModel UsualCamera() {
  CameraModel camera;
  camera.width_px = 1280;
  camera.height_px = 720;
  camera.fx_px = 897.5;
  camera.fy_px = 896.8;
  camera.cx_px = 635.4;
  camera.cy_px = 375.3;
  camera.distortion = {-0.44, 0.233, 0.001, 0.0002, -0.073};
  return camera;
}

TEST(BoardDoubts, AcceptsUsualBoards) {
  EXPECT_THAT(BoardDoubts(UsualBoard()), IsEmpty());
  BoardSpec board = UsualBoard();
  board.pattern = "charuco";
  board.marker_m = 0.05;
  EXPECT_THAT(BoardDoubts(board), IsEmpty());
}

TEST(BoardDoubts, NamesAnotherUnit) {
  BoardSpec board = UsualBoard();
  board.width_m = 767;
  board.height_m = 62.6;
  EXPECT_THAT(BoardDoubts(board),
              ElementsAre(HasSubstr("board.width_m is 767: it is in metres, and usually 0.1 to 5: "
                                    "in millimetres? Then give 0.767"),
                          HasSubstr("in centimetres? Then give 0.626")));
}

TEST(BoardDoubts, NamesTheKeysOfThePattern) {
  BoardSpec board = UsualBoard();
  board.pattern = "aprilgrid";
  board.square_m = 88;
  board.num_corners_x = board.num_corners_y = 12;
  EXPECT_THAT(BoardDoubts(board),
              ElementsAre(HasSubstr("board.tagSize is 88: it is in metres"),
                          HasSubstr("board.tagSize is 88: the pattern")));
}

TEST(BoardDoubts, NamesWhyThePatternSticksOut) {
  BoardSpec board = UsualBoard();
  std::swap(board.width_m, board.height_m);
  EXPECT_THAT(BoardDoubts(board), ElementsAre(HasSubstr("swapped?")));
  board = UsualBoard();
  board.square_m = 0.09;
  EXPECT_THAT(
      BoardDoubts(board),
      ElementsAre(HasSubstr("board.square_m is 0.09: the pattern, 0.81 x 0.63 m, sticks out "
                            "of the board, 0.767 x 0.626 m (width x height): are corners "
                            "counted, not squares")));
  board = UsualBoard();
  board.pattern_offset_x_m = 0.2;
  EXPECT_THAT(BoardDoubts(board), ElementsAre(HasSubstr("are pattern_offset_x_m and _y_m right?")));
}

TEST(CameraDoubts, AcceptsUsualCameras) {
  EXPECT_THAT(CameraDoubts(UsualCamera()), IsEmpty());
  CameraModel fisheye = UsualCamera();
  fisheye.lens = LensModel::kEquidistant;
  fisheye.distortion = {};
  fisheye.fx_px = fisheye.fy_px = 350;  // 210 degrees
  EXPECT_THAT(CameraDoubts(fisheye), IsEmpty());
  CameraModel wide = UsualCamera();  // a calibration that turns back short of the image's edges
  wide.fx_px = wide.fy_px = 685;
  wide.distortion = {-0.353, 0.149, -0.001, -0.0002, -0.0326};
  EXPECT_THAT(CameraDoubts(wide), IsEmpty());
}

TEST(CameraDoubts, NamesTheExampleThatNobodyChanged) {
  CameraModel camera = ExampleCamera();
  EXPECT_THAT(CameraDoubts(camera), ElementsAre(HasSubstr("is the example")));
  camera.cx_px += 1;
  EXPECT_THAT(CameraDoubts(camera), IsEmpty());
}

TEST(AddressDoubt, TellsTheLidarsAddressFromTheHosts) {
  EXPECT_EQ(AddressDoubt("0.0.0.0"), "");
  EXPECT_THAT(AddressDoubt("239.255.0.1"), HasSubstr("no network card"));  // no group is joined
  EXPECT_THAT(AddressDoubt("lidar.local"), HasSubstr("no IPv4 address"));
  EXPECT_THAT(AddressDoubt("127.0.0.1"), HasSubstr("only what this host itself sends"));
  // RFC 5737: of documentation, nobody's
  EXPECT_THAT(AddressDoubt("192.0.2.1"), HasSubstr("not the lidar's"));
}

TEST(CameraDoubts, NamesAnotherLensModelsCoefficients) {
  CameraModel camera = UsualCamera();
  camera.distortion = {-0.054, -0.078, 0.096, -0.052};
  EXPECT_THAT(CameraDoubts(camera), ElementsAre(HasSubstr("of an equidistant lens")));
  camera.lens = LensModel::kEquidistant;
  EXPECT_THAT(CameraDoubts(camera), IsEmpty());
}

TEST(RigDoubts, NamesMillimetres) {
  Rig rig;
  rig.board = UsualBoard();
  rig.camera = UsualCamera();
  rig.T_camera_lidar_guess = Eigen::Isometry3d(Eigen::Translation3d(60, -100, -40));
  rig.lidar_board_detector.max_range_m = 12000;
  EXPECT_THAT(RigDoubts(rig),
              ElementsAre(HasSubstr("puts the lidar 123.3 m from the camera"),
                          HasSubstr("max_range_m is 12000: it is in metres: in millimetres? Then "
                                    "give 12")));
}

TEST(CameraDoubts, NamesFocalLengthsThatAreNotInPixels) {
  CameraModel camera = UsualCamera();
  camera.fx_px = 0.7;
  camera.fy_px = 0.7;
  EXPECT_THAT(CameraDoubts(camera),
              ElementsAre(HasSubstr("camera.fx_px is 0.7: it is in pixels"),
                          HasSubstr("camera.fy_px is 0.7: it is in pixels")));
  camera = UsualCamera();
  camera.fy_px = 2 * camera.fx_px;
  EXPECT_THAT(CameraDoubts(camera),
              ElementsAre(HasSubstr("camera.fy_px is 1795, 2 times fx_px (897.5)")));
  camera.fy_px = 1.1 * camera.fx_px;
  EXPECT_THAT(CameraDoubts(camera), ElementsAre(HasSubstr("1.1 times fx_px")));
  camera.fy_px = 1.02 * camera.fx_px;  // as of no pinhole, but of many a fitted one
  EXPECT_THAT(CameraDoubts(camera), IsEmpty());
}

TEST(CameraDoubts, NamesWhyThePrincipalPointIsOffTheMiddle) {
  CameraModel camera = UsualCamera();
  std::swap(camera.cx_px, camera.cy_px);
  EXPECT_THAT(CameraDoubts(camera), ElementsAre(HasSubstr("are cx_px and cy_px swapped")));
  camera = UsualCamera();
  std::swap(camera.width_px, camera.height_px);
  EXPECT_THAT(CameraDoubts(camera), ElementsAre(HasSubstr("or width_px and height_px?")));
  camera = UsualCamera();
  camera.cx_px /= 2;
  camera.cy_px /= 2;
  EXPECT_THAT(CameraDoubts(camera),
              ElementsAre(HasSubstr("an image of about 635 x 375 px. Look at an image")));
  camera = UsualCamera();
  camera.width_px = 640;
  camera.cx_px = 3200;
  EXPECT_THAT(CameraDoubts(camera),
              ElementsAre(HasSubstr("camera.cx_px, cy_px are 3200, 375.3: far from the middle")));
}

TEST(CameraDoubts, NamesALensThatReachesLittleOfTheImage) {
  CameraModel camera = UsualCamera();
  camera.distortion = {-5, 0, 0, 0, 0};
  EXPECT_THAT(CameraDoubts(camera), ElementsAre(HasSubstr("camera.distortion: ")));
}

TEST(DriverDoubts, NamesFilesThatAreNotThere) {
  Rig rig;
  rig.lidar_driver.folder = "/nowhere/clouds";
  rig.camera_driver.source = CameraDriverOptions::Source::kVideo;
  rig.camera_driver.url = "/nowhere/film.mp4";
  EXPECT_THAT(DriverDoubts(rig),
              ElementsAre(HasSubstr("lidar_driver.folder: /nowhere/clouds: cannot be read"),
                          HasSubstr("camera_driver.url is /nowhere/film.mp4: there is no such")));
  rig.lidar_driver.source = LidarDriverOptions::Source::kSensor;
  rig.lidar_sensor.pcap = "/nowhere/capture.pcap";
  rig.camera_driver.url = "rtsp://camera/stream";
  EXPECT_THAT(DriverDoubts(rig), ElementsAre(HasSubstr("lidar_driver.sensor.pcap is /nowhere")));
}

TEST(DriverDoubts, NamesFramesThatHardlyPair) {
  const test::TemporaryFolder clouds;
  const test::TemporaryFolder images;
  for (const char* name : {"1.pcd", "2.pcd"}) clouds.Write(name, "");
  for (const char* name : {"1700000001.25.png", "1700000002.25.png"}) images.Write(name, "");
  Rig rig;
  EXPECT_THAT(DriverDoubts(rig), IsEmpty());  // none named: for recordings
  rig.lidar_driver.folder = clouds.path();
  rig.camera_driver.folder = images.path();
  EXPECT_THAT(DriverDoubts(rig),
              ElementsAre(HasSubstr("the names of the clouds have numbers, those of the images "
                                    "times")));
  rig.lidar_driver.is_by_order = rig.camera_driver.is_by_order = true;
  EXPECT_THAT(DriverDoubts(rig), IsEmpty());
  EXPECT_EQ(PairingOfDrivers(rig), "2 pairs, by their order");
}

}  // namespace
}  // namespace voqcal
