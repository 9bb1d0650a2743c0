// calibrate_lens: from a recording of a camera that nobody knows to a rig file that others take.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "support/simulated_log.hpp"
#include "support/synthetic_board_image.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

constexpr char kRigText[] =
    "rig: unknown lens\n"
    "board:\n"
    "  width_m: 0.61\n"
    "  height_m: 0.85\n"
    "  square_m: 0.095\n"
    "  num_corners_x: 5\n"
    "  num_corners_y: 7\n"
    "  pattern_offset_x_m: 0.002\n"
    "camera:  # to be found\n"
    "  lens_model: equidistant\n";

class CalibrateLens : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.path() / name; }

  /// A still of each place and tilt, so many. Not tilted: each faces the camera.
  std::string WriteLog(int num_poses, bool is_tilted) const {
    const std::string path = Path(is_tilted ? "board.lcm" : "flat.lcm");
    const CameraModel camera = test::SmallCamera(LensModel::kEquidistant);
    LogWriter log(path);
    for (int i = 0; i < num_poses; ++i) {
      const double turn_rad = 35 * kRadPerDeg * (is_tilted ? 1 : 0);
      const double towards_rad = 2.4 * i;  // the golden angle: no two alike
      Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
      T_camera_board.linear() =
          ExpSO3({turn_rad * std::cos(towards_rad), turn_rad * std::sin(towards_rad), 0}) *
          ExpSO3({M_PI, 0, 0});
      T_camera_board.translation() << 0.45 * (i % 3 - 1), 0.12 * (i / 3 % 3 - 1), 1.5;
      const cv::Mat image = test::RenderBoard(camera, test::TestBoard(), T_camera_board);
      test::WriteEvent("CAMERA_IMAGE", ToMessage(image, (i + 1) * 2'000'000, i), &log);
    }
    return path;
  }

  test::Outcome Run(const std::string& log, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> args = {test::Program("calibrate_lens"), rig_, "--log", log};
    args.insert(args.end(), more.begin(), more.end());
    return test::Run(args);
  }

  test::TemporaryFolder folder_;
  std::string rig_ = folder_.Write("rig.yaml", kRigText);
};

TEST_F(CalibrateLens, WritesARigFileThatOthersTake) {
  const std::vector<std::string> check = {test::Program("check_rig"), rig_};
  const test::Outcome before = test::Run(check);
  EXPECT_EQ(before.status, 1);
  EXPECT_THAT(before.err, HasSubstr("camera.fx_px is missing (calibrate_lens finds"));
  // It can be recorded with, as tools/record asks.
  EXPECT_EQ(test::Run({check[0], rig_, "--lcm-url", "--without-lens"}).status, 0);

  const test::Outcome outcome = Run(WriteLog(12, true), {"--write", Path("new.yaml")});
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("12 with a board"),
                    HasSubstr("held out"),
                    HasSubstr("fx_px "),
                    HasSubstr("camera:\n  lens_model: equidistant\n  width_px: 640\n"),
                    HasSubstr("written\n")));
  EXPECT_THAT(ReadWholeFile(Path("new.yaml")), HasSubstr("camera:  # to be found\n"));
  const Rig rig = LoadRig(Path("new.yaml"));
  const CameraModel truth = test::SmallCamera(LensModel::kEquidistant);
  EXPECT_NEAR(rig.camera.fx_px, truth.fx_px, 0.005 * truth.fx_px);
  EXPECT_NEAR(rig.camera.cx_px, truth.cx_px, 0.01 * truth.fx_px);

  // There is one now; it is not overwritten unasked. And it says what a rig file's lens is worth.
  EXPECT_EQ(Run(Path("board.lcm"), {"--write", Path("new.yaml")}).status, 1);
  rig_ = Path("new.yaml");
  EXPECT_THAT(Run(Path("board.lcm")).out, HasSubstr("rig file    its intrinsics (equidistant"));
}

// Folders are meant beside the rig file.
TEST_F(CalibrateLens, WritesNoCopyWhosePathsWouldBeOthers) {
  const std::string log = WriteLog(12, true);
  rig_ =
      folder_.Write("with_paths.yaml", std::string(kRigText) + "camera_driver: {folder: images}\n");
  const test::Outcome outcome = Run(log, {"--write", Path("elsewhere/new.yaml")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err,
              HasSubstr("camera_driver.folder of the rig file would be another path there"));
  EXPECT_FALSE(std::filesystem::exists(Path("elsewhere")));
  EXPECT_EQ(Run(log, {"--write", Path("beside.yaml")}).status, 0);
}

constexpr char kSeveralText[] =
    "rig: truck  # of two cameras\n"
    "board: {width_m: 0.61, height_m: 0.85, square_m: 0.095, num_corners_x: 5, num_corners_y: 7, "
    "pattern_offset_x_m: 0.002}\n"
    "lidars:\n"
    "  top:\n"
    "cameras:\n"
    "  right:\n"
    "    camera_driver: {folder: images}\n"
    "  left:\n"
    "    channels: {camera_image: CAMERA_IMAGE}\n"
    "    camera:  # to be found\n"
    "      lens_model: equidistant\n"
    "# the end";

TEST_F(CalibrateLens, WritesACameraOfSeveralIntoItsOwnSection) {
  const std::string log = WriteLog(12, true);
  const std::string file = folder_.Write("truck.yaml", kSeveralText);
  rig_ = file + "#left";
  const test::Outcome elsewhere = Run(log, {"--write", Path("elsewhere/new.yaml")});
  EXPECT_THAT(
      elsewhere.err,
      HasSubstr("cameras.right.camera_driver.folder of the rig file would be another path"));
  const test::Outcome outcome = Run(log, {"--write", Path("new.yaml")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string written = ReadWholeFile(Path("new.yaml"));
  EXPECT_NEAR(LoadRig(Path("new.yaml") + "#left", SensorChoice::kCamera).camera.fx_px, 420, 2);

  // Without the found camera it is the file that it was.
  const std::size_t begin = written.find("      width_px: 640\n");
  const std::size_t end = written.find("      lens_model: equidistant\n");
  ASSERT_LT(begin, end);
  EXPECT_EQ(written.substr(0, begin) + written.substr(end), kSeveralText);

  rig_ = file + "#lefd";
  EXPECT_THAT(Run(log, {"--write", Path("other.yaml")}).err, HasSubstr("did you mean left?"));
  rig_ = file;
  EXPECT_THAT(Run(log, {"--write", Path("other.yaml")}).err, HasSubstr("name a camera, as in"));
}

TEST_F(CalibrateLens, TakesARecordingOfRos) {
  const std::string log = WriteLog(12, true);
  const test::Outcome made =
      test::Run({std::string(VOQCAL_SOURCE_DIR) + "/test/system/with_node.sh",
                 "node",
                 std::string(VOQCAL_SOURCE_DIR) + "/test/system/log_to_recording.mjs",
                 log,
                 Path("board.bag"),
                 "mono8"});
  if (made.status == 77) GTEST_SKIP() << made.out;
  ASSERT_EQ(made.status, 0) << made.err;
  const auto lens_of = [](const test::Outcome& outcome) {
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out.substr(outcome.out.find("for the rig file"));
  };
  EXPECT_EQ(lens_of(test::Run({test::Program("calibrate_lens"), rig_, "--bag", Path("board.bag")})),
            lens_of(Run(log)));
}

TEST_F(CalibrateLens, SaysWhyALensShouldNotBeUsed) {
  const test::Outcome few = Run(WriteLog(5, true), {"--write", Path("new.yaml")});
  EXPECT_EQ(few.status, 3);
  EXPECT_THAT(few.err,
              MatchesRegex("calibrate_lens: do not use it: 5 images of different poses[^\n]*\n"));
  EXPECT_FALSE(std::filesystem::exists(Path("new.yaml")));

  const test::Outcome flat = Run(WriteLog(9, false), {"--lens-model", "plumb_bob"});
  EXPECT_EQ(flat.status, 3);
  EXPECT_THAT(flat.err,
              MatchesRegex("calibrate_lens: do not use it: [^\n]*tilt the board by [^\n]*\n"));
}

TEST_F(CalibrateLens, RefusesWrongInputByOneLine) {
  const auto expect_refused = [](const test::Outcome& outcome, const std::string& word) {
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, AllOf(MatchesRegex("calibrate_lens: [^\n]*\n"), HasSubstr(word)));
  };
  expect_refused(Run(Path("missing.lcm")), "missing.lcm");
  const std::string log = WriteLog(1, true);
  folder_.Write("rig.yaml", std::string(kRigText) + "  width_px: 641\n");
  expect_refused(Run(log), "the images are 640 x 400");
  folder_.Write("rig.yaml", std::string(kRigText) + "channels: {camera_image: LEFT}\n");
  expect_refused(Run(log), "no image can be read on LEFT");
}

}  // namespace
}  // namespace voqcal
