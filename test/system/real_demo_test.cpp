// tools/demo --real: from a folder or a log and the board's numbers to a result by one command.

#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.hpp"
#include "images/jpeg.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"
#include "support/matchers.hpp"
#include "support/simulated_log.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class RealDemo : public ::testing::Test {
 protected:
  RealDemo() {
    rig_.simulation.num_poses = 9;
    board_ = {"board.width_m=" + std::to_string(rig_.board.width_m),
              "board.height_m=" + std::to_string(rig_.board.height_m),
              "board.square_m=" + std::to_string(rig_.board.square_m),
              "board.num_corners_x=" + std::to_string(rig_.board.num_corners_x),
              "board.num_corners_y=" + std::to_string(rig_.board.num_corners_y),
              "board.pattern_offset_x_m=" + std::to_string(rig_.board.pattern_offset_x_m),
              "board.pattern_offset_y_m=" + std::to_string(rig_.board.pattern_offset_y_m)};
  }

  std::string Path(const std::string& name) const { return folder_.path() / name; }

  /// A frame of each stop, as people keep them: folders and files of any names, clouds as text.
  std::string WriteFolders() const {
    const Simulation simulation(rig_.simulation, rig_.board, rig_.camera);
    for (const char* folder : {"data/left", "data/velodyne"}) {
      std::filesystem::create_directories(Path(folder));
    }
    for (int stop = 0; stop < rig_.simulation.num_poses; ++stop) {
      const double time_s = stop * (rig_.simulation.hold_s + rig_.simulation.move_s) + 0.1;
      const std::string number = std::to_string(stop);
      const auto jpeg = EncodeJpeg(simulation.Image(time_s), 95);
      folder_.Write("data/left/" + number + ".jpg", {jpeg.begin(), jpeg.end()});
      folder_.Write("data/velodyne/" + number + ".pcd", PcdText(simulation.Sweep(time_s)));
    }
    return Path("data");
  }

  static std::string PcdText(const PointCloud& cloud) {
    const std::string num = std::to_string(cloud.points.size());
    std::ostringstream text;
    text << "VERSION .7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH "
         << num << "\nHEIGHT 1\nPOINTS " << num << "\nDATA ascii\n";
    for (const LidarPoint& point : cloud.points) {
      text << point.position_m.transpose() << ' ' << point.intensity << '\n';
    }
    return text.str();
  }

  test::Outcome Demo(std::vector<std::string> args) const {
    args.insert(args.begin(), {test::Tool("demo"), "--real"});
    args.insert(args.end(), {"--out", Path("out")});
    return test::Run(args);
  }

  Rig rig_ = test::TinySimulatedRig();
  std::vector<std::string> board_;
  test::TemporaryFolder folder_;
};

TEST_F(RealDemo, AsksForEachNumberOfTheBoardByName) {
  std::filesystem::create_directories(Path("data"));
  const test::Outcome outcome = Demo({Path("data"), board_[0], board_[4]});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("board.height_m=0.85 "),
                    HasSubstr("board.square_m=0.095 "),
                    HasSubstr("board.num_corners_x=5 "),
                    Not(HasSubstr("board.width_m=")),
                    Not(HasSubstr("board.num_corners_y="))));
}

// Its intrinsics are estimated from a dozen small images: to some permille of the focal length.
TEST_F(RealDemo, CalibratesFoldersWithTheBoardsNumbersAlone) {
  std::vector<std::string> args = {WriteFolders()};
  args.insert(args.end(), board_.begin(), board_.end());
  const test::Outcome outcome = Demo(args);
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("intrinsics are estimated from "));
  EXPECT_THAT(outcome.out,
              HasSubstr("\ncamera     no calibration of it was given: its intrinsics were "
                        "estimated from "));
  EXPECT_TRUE(std::filesystem::exists(Path("out/report.html")));
  EXPECT_THAT(ReadExtrinsic(Path("out/extrinsic.yaml")),
              test::IsNear(rig_.simulation.T_camera_lidar, 0.7 * kRadPerDeg, 0.03));
}

TEST_F(RealDemo, TakesTheCameraFromTheFileThatRosLeft) {
  test::WriteStopsLog(rig_, Path("raw.lcm"));
  folder_.Write(
      "ost.yaml",
      "image_width: 640\nimage_height: 400\ncamera_name: left\n"
      "camera_matrix: {rows: 3, cols: 3, data: [401.5, 0, 320.5, 0, 402.5, 199, 0, 0, 1]}\n"
      "distortion_model: equidistant\n"
      "distortion_coefficients: {rows: 1, cols: 4, data: [0.01, -0.02, 0.003, 0]}\n"
      "rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n");
  std::vector<std::string> args = {test::Program("draft_rig"), Path("raw.lcm")};
  args.insert(args.end(), board_.begin(), board_.end());
  args.insert(args.end(), {"--camera", Path("ost.yaml"), "--out", Path("rig.yaml")});
  const test::Outcome outcome = test::Run(args);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Rig drafted = LoadRig(Path("rig.yaml"));
  EXPECT_EQ(drafted.camera.lens, LensModel::kEquidistant);
  EXPECT_EQ(drafted.camera.width_px, 640);
  EXPECT_EQ(drafted.camera.fy_px, 402.5);
  EXPECT_EQ(drafted.camera.distortion[1], -0.02);
  EXPECT_EQ(drafted.board.num_corners_y, rig_.board.num_corners_y);
}

}  // namespace
}  // namespace voqcal
