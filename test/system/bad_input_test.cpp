// Bad input ends in one line that names the file and the cause, with status 1, and leaves nothing.

#include <algorithm>
#include <cstdlib>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "rig_status/status_page.hpp"
#include "sample_collector/session_log.hpp"
#include "support/simulated_log.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

constexpr char kRigText[] =
    "rig: small\n"
    "board: {width_m: 0.6, height_m: 0.8, square_m: 0.1, num_corners_x: 4, num_corners_y: 6}\n"
    "camera: {lens_model: plumb_bob, width_px: 64, height_px: 48, fx_px: 50, fy_px: 50,\n"
    "  cx_px: 32, cy_px: 24, distortion: [0, 0, 0, 0, 0]}\n";

class BadInput : public ::testing::Test {
 protected:
  BadInput() { setenv("TMPDIR", folder_.path().c_str(), 1); }  // evaluate works there
  ~BadInput() override { unsetenv("TMPDIR"); }

  std::string Path(const std::string& name) const { return folder_.path() / name; }

  /// `num_frames` clouds and grey images; clouds of a thousand points that are all NaN.
  std::string WriteLog(int num_frames, int width_px = 64) const {
    PointCloud cloud;
    cloud.points.resize(1000);
    for (LidarPoint& point : cloud.points) {
      point.position_m.setConstant(std::numeric_limits<float>::quiet_NaN());
    }
    LogWriter log(Path("raw.lcm"));
    for (int i = 0; i < num_frames; ++i) {
      test::WriteEvent("LIDAR_POINTS", ToMessage(cloud, i * 100'000, i), &log);
      const cv::Mat image(48, width_px, CV_8UC1, cv::Scalar(90));
      test::WriteEvent("CAMERA_IMAGE", ToMessage(image, i * 100'000, i), &log);
    }
    return Path("raw.lcm");
  }

  /// A session of cam_lidar_calibration with one pose, of which nothing is read.
  std::string AcfrSession() const {
    for (const char* folder : {"data/pcd", "data/images"}) {
      std::filesystem::create_directories(Path(folder));
    }
    folder_.Write("data/pcd/pose1_full.pcd", "");
    folder_.Write("data/images/pose1.png", "");
    return Path("data");
  }

  /// Runs a program that must refuse: one line that begins with its name and matches `line`, and
  /// one for each advice.
  template <typename Matcher>
  void ExpectRefused(const std::vector<std::string>& args, const Matcher& line) const {
    const std::vector<std::string> before = test::NamesIn(folder_.path());
    const test::Outcome outcome = test::Run(args);
    const std::string program = std::filesystem::path(args[0]).filename();
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(StartsWith(program + ": "), line));
    EXPECT_THAT(outcome.err, MatchesRegex("(" + program + ": [^\n]*\n)+"));
    EXPECT_THAT(outcome.out, IsEmpty());
    TakeAwayWhatWasSeen();
    EXPECT_EQ(test::NamesIn(folder_.path()), before);
  }
  /// Where frames gave no result, calibrate leaves a page of them, and nothing else.
  void TakeAwayWhatWasSeen() const {
    if (!std::filesystem::remove(Path("out/no_result.html"))) return;
    std::error_code error;  // an earlier result may be in it
    std::filesystem::remove(Path("out"), error);
  }
  template <typename Matcher>
  void ExpectCalibrateRefuses(const std::string& input,
                              const std::string& file,
                              const Matcher& line) const {
    ExpectRefused({test::Program("calibrate"), "--rig", rig_, input, file, "--out", Path("out")},
                  line);
  }
  template <typename Matcher>
  void ExpectRigRefused(const std::string& text, const Matcher& line) {
    folder_.Write("rig.yaml", text);
    ExpectCalibrateRefuses("--log", WriteLog(1), AllOf(HasSubstr(rig_), line));
  }

  test::TemporaryFolder folder_;
  std::string rig_ = folder_.Write("rig.yaml", kRigText);
};

// Nobody reads here: what is played goes nowhere, at once.
TEST_F(BadInput, ReplayLeavesOutWhatNoModuleCouldRead) {
  {
    LogWriter log(WriteLog(2));
    log.Write({0, 0, "CAMERA_IMAGE", {1, 2, 3}});
    log.Write({0, 0, "LIDAR_POINTS", EncodeMessage(image_t{})});
    log.Write({0, 0, "LIDAR_POINTS", {}});
  }
  const test::Outcome outcome =
      test::Run({test::Program("replay"), rig_, Path("raw.lcm"), "--lcm-url", "memq://"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(StartsWith("4 messages played\n"),
                    HasSubstr("1 CAMERA_IMAGE left out, which no module could read; the first: 3 "
                              "bytes that are no image_t\n"),
                    HasSubstr("2 LIDAR_POINTS left out, which no module could read; the first: ")));
}

TEST_F(BadInput, MissingFiles) {
  const std::string missing = Path("missing");
  ExpectCalibrateRefuses("--log", missing, HasSubstr(missing + ": no such file"));
  ExpectCalibrateRefuses("--poses", missing, HasSubstr(missing));
  const std::string log = WriteLog(1);
  ExpectRefused({test::Program("evaluate"), "--rig", rig_, "--log", log, "--extrinsic", missing},
                HasSubstr(missing));
  ExpectRefused({test::Program("import_acfr"), missing, "--rig", rig_, "--out", Path("new/out")},
                HasSubstr(missing));
  ExpectRefused({test::Program("compare"), missing, "--truth-of", rig_}, HasSubstr(missing));
  rig_ = missing;
  ExpectCalibrateRefuses("--log", log, HasSubstr(missing));
}

TEST_F(BadInput, RigFileWithAWrongKey) {
  ExpectRigRefused(std::string(kRigText) + "colour: red\n", HasSubstr("colour"));
  ExpectRigRefused(test::Replaced(kRigText, "square_m: 0.1, ", ""), HasSubstr("square_m"));
  ExpectRigRefused(test::Replaced(kRigText, "square_m: 0.1", "square_m: wide"),
                   AllOf(HasSubstr("square_m"), HasSubstr("wide")));
  ExpectRigRefused("rig: [\n", HasSubstr("rig.yaml"));
}

TEST_F(BadInput, EveryModuleRefusesAWrongRigFile) {
  folder_.Write("rig.yaml", std::string(kRigText) + "colour: red\n");
  for (const std::string& module : AllModuleNames()) {
    ExpectRefused({test::Program(module), "--rig", rig_, "--session", Path("session")},
                  AllOf(HasSubstr(rig_), HasSubstr("colour")));
  }
}

TEST_F(BadInput, LogThatIsCutOffIsUsedUpToThere) {
  const std::string log = WriteLog(2);
  const std::string whole = ReadWholeFile(log);
  folder_.Write("raw.lcm", whole.substr(0, whole.size() - 1));
  const test::Outcome outcome =
      test::Run({test::Program("calibrate"), "--rig", rig_, "--log", log, "--out", Path("out")});
  EXPECT_EQ(outcome.status, 1);  // the frames before the cut show no board
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("warning: " + log + ": byte " +
                              std::to_string(whole.rfind("\xED\xA1\xDA\x01")) + ": "),
                    HasSubstr("bytes are left out"),
                    HasSubstr("fewer than three samples"),
                    HasSubstr("2 too few points")));
}

TEST_F(BadInput, SamplesLogCut) {
  {
    SessionLog session(folder_.path());
    for (const BoardSample& sample : test::SynthesizeSamples({})) session.Accept(sample);
  }
  const std::string log = Path("samples.lcm");
  const std::string whole = ReadWholeFile(log);
  folder_.Write("samples.lcm", whole.substr(0, whole.size() - 10));
  ExpectCalibrateRefuses("--log", log, AllOf(HasSubstr(log), HasSubstr("cut off")));
  EXPECT_EQ(std::filesystem::file_size(log), whole.size() - 10);  // not mended either
}

TEST_F(BadInput, FolderOfASessionThatIsStillCollecting) {
  const SessionLog session(folder_.path() / "out");
  const std::string log = WriteLog(1);
  ExpectCalibrateRefuses("--log", log, AllOf(HasSubstr("samples.lcm"), HasSubstr("being written")));
}

TEST_F(BadInput, LogThatIsNone) {
  const std::string log = folder_.Write("raw.lcm", "these are no events\n");
  ExpectCalibrateRefuses("--log", log, AllOf(HasSubstr(log), HasSubstr("no LCM log event")));
  folder_.Write("raw.lcm", "");
  ExpectCalibrateRefuses("--log", log, AllOf(HasSubstr(log), HasSubstr("no channel")));
}

TEST_F(BadInput, LogWithoutTheChannels) {
  const std::string log = Path("raw.lcm");
  LogWriter(log).Write({0, 0, "POSE", {1, 2, 3}});
  ExpectCalibrateRefuses(
      "--log", log, AllOf(HasSubstr(log), HasSubstr("LIDAR_POINTS"), HasSubstr("POSE")));
}

TEST_F(BadInput, ImageOfAnotherSizeThanTheCameras) {
  const std::string log = WriteLog(2, 80);
  ExpectCalibrateRefuses(
      "--log", log, AllOf(HasSubstr(log), HasSubstr("80 x 48"), HasSubstr("64 x 48")));
}

TEST_F(BadInput, CloudsOfNothingButNan) {
  const std::string log = WriteLog(3);
  ExpectCalibrateRefuses(
      "--log",
      log,
      AllOf(HasSubstr(log),
            HasSubstr("fewer than three samples"),
            HasSubstr("3 too few points"),
            HasSubstr("\ncalibrate: lidar_board_detector: \"too few points\" 3 times of 3: check "
                      "lidar_board_detector.min_range_m"),
            HasSubstr("\ncalibrate: camera_board_detector: \"no board\" 3 times of 3: ")));
  ExpectRefused({test::Program("evaluate"),
                 "--rig",
                 rig_,
                 "--log",
                 log,
                 "--extrinsic",
                 folder_.Write("extrinsic.yaml",
                               "T_camera_lidar: {quaternion_xyzw: [0, 0, 0, 1], "
                               "translation_m: [0, 0, 0]}\n")},
                AllOf(HasSubstr(log), HasSubstr("no sample")));
}

TEST_F(BadInput, FewerThanThreeSamples) {
  test::SyntheticSamplesOptions two;
  two.num_samples = 2;
  {
    SessionLog session(folder_.path());
    for (const BoardSample& sample : test::SynthesizeSamples(two)) session.Accept(sample);
  }
  const std::string log = Path("samples.lcm");
  ExpectCalibrateRefuses(
      "--log",
      log,
      AllOf(HasSubstr(log), HasSubstr("fewer than three samples"), HasSubstr("2 of 2")));
  // An earlier result stays, and nobody takes it for this one.
  std::filesystem::create_directory(Path("out"));
  const std::string earlier = folder_.Write("out/extrinsic.yaml", "earlier\n");
  ExpectCalibrateRefuses("--log", log, HasSubstr("; " + earlier + " is of an earlier run"));
  EXPECT_EQ(ReadWholeFile(earlier), "earlier\n");
}

TEST_F(BadInput, TableOfPosesCut) {
  std::string text;
  for (int line = 0; line < 19 + 7; ++line) text += "1,2,3\n";  // a pose and a part
  const std::string table = folder_.Write("poses.csv", text);
  ExpectCalibrateRefuses("--poses", table, HasSubstr(table));
  folder_.Write("poses.csv", "");
  ExpectCalibrateRefuses("--poses", table, HasSubstr(table));
}

TEST_F(BadInput, AFileInTheWayOfOut) {
  SessionLog(folder_.path() / "session").Reset();
  const std::string log = Path("session/samples.lcm");
  const std::string in_the_way = folder_.Write("file", "precious");
  for (const std::string& out : {in_the_way, in_the_way + "/out"}) {
    ExpectRefused({test::Program("calibrate"), "--rig", rig_, "--log", log, "--out", out},
                  HasSubstr(in_the_way));
  }
  EXPECT_EQ(ReadWholeFile(in_the_way), "precious");
}

TEST_F(BadInput, OutputThatCannotBeWrittenIsNamedWithTheCause) {
  SessionLog(folder_.path() / "session").Reset();
  const std::string log = Path("session/samples.lcm");
  for (const std::string program : {"calibrate", "import_acfr"}) {
    const std::vector<std::string> args =
        program == "calibrate"
            ? std::vector<std::string>{"--rig", rig_, "--log", log, "--out", "/proc/out"}
            : std::vector<std::string>{AcfrSession(), "--rig", rig_, "--out", "/proc/out"};
    std::vector<std::string> command = {test::Program(program)};
    command.insert(command.end(), args.begin(), args.end());
    ExpectRefused(command, HasSubstr(program + ": /proc/out: cannot be written: "));
  }
}

TEST_F(BadInput, CheckRigPrintsARigFileThatItTakesOnceTheCameraIsGiven) {
  const test::Outcome printed = test::Run({test::Program("check_rig"), "--print-defaults"});
  EXPECT_EQ(printed.status, 0) << printed.err;
  const std::string rig = folder_.Write("default.yaml", printed.out);
  const test::Outcome unchanged = test::Run({test::Program("check_rig"), rig});
  EXPECT_EQ(unchanged.status, 3);
  EXPECT_THAT(unchanged.err, HasSubstr("camera: is the example that check_rig --print-defaults"));
  folder_.Write("default.yaml", test::Replaced(printed.out, "fx_px: 750 ", "fx_px: 752.5 "));
  const test::Outcome outcome = test::Run({test::Program("check_rig"), rig});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST_F(BadInput, RigFileThatCanHardlyBeRight) {
  folder_.Write("rig.yaml", test::Replaced(kRigText, "width_m: 0.6", "width_m: 600"));
  const test::Outcome outcome = test::Run({test::Program("check_rig"), rig_});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err,
              AllOf(StartsWith("check_rig: " + rig_),
                    HasSubstr("board.width_m is 600: it is in metres, and usually 0.1 to 5: in "
                              "millimetres? Then give 0.6")));
  EXPECT_THAT(outcome.out, ::testing::Not(HasSubstr("is usable")));
}

TEST_F(BadInput, StandardOutputOnAFullDisk) {
  const test::Outcome outcome = test::Run(
      {"/bin/sh", "-c", "exec \"$0\" \"$1\" >/dev/full", test::Program("check_rig"), rig_});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err,
            "check_rig: standard output: cannot be written: No space left on device\n");
}

TEST_F(BadInput, AFileThatIsThereIsOverwrittenOnlyIfForced) {
  const std::string there = folder_.Write("there", "precious");
  const std::string is_there = there + ": is there already (--force overwrites it)";
  ExpectRefused({test::Program("import_acfr"), AcfrSession(), "--rig", rig_, "--out", there},
                HasSubstr(is_there));
  std::filesystem::create_directory(Path("result"));
  folder_.Write("result/extrinsic.yaml",
                "T_camera_lidar: {quaternion_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0]}\n");
  const std::vector<std::string> args = {
      test::Program("export_extrinsic"), Path("result"), "--format", "ros", "--out", there};
  ExpectRefused(args, HasSubstr(is_there));
  EXPECT_EQ(ReadWholeFile(there), "precious");
  std::vector<std::string> forced = args;
  forced.push_back("--force");
  EXPECT_EQ(test::Run(forced).status, 0);
  EXPECT_THAT(ReadWholeFile(there), HasSubstr("static_transform_publisher"));
}

TEST_F(BadInput, ARefusedRunLeavesAnEarlierResultAsItIs) {
  std::filesystem::create_directory(Path("out"));
  folder_.Write("out/extrinsic.yaml", "earlier");
  ExpectCalibrateRefuses("--log", WriteLog(2), HasSubstr("fewer than three samples"));
  EXPECT_EQ(ReadWholeFile(Path("out/extrinsic.yaml")), "earlier");
  EXPECT_EQ(test::NamesIn(Path("out")), std::vector<std::string>{"extrinsic.yaml"});
}

TEST_F(BadInput, RunRigStartsNothingWithARigThatCannotBeRead) {
  const std::string missing = Path("missing.yaml");
  const test::Outcome outcome =
      test::Run({test::Tool("run_rig"), missing, "--session", Path("session")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr(missing + ": cannot be read"));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_EQ(test::NamesIn(folder_.path()), std::vector<std::string>{"rig.yaml"});
}

TEST_F(BadInput, ScriptsBeforeTheBuildSayHowToBuild) {
  const std::string bin = std::getenv("VOQCAL_BIN");
  setenv("VOQCAL_BIN", folder_.path().c_str(), 1);  // a folder without programs
  for (const char* script : {"up", "down", "run_rig", "status", "spy"}) {
    ExpectRefused({test::Tool(script), rig_}, HasSubstr("not built yet: run tools/build"));
  }
  setenv("VOQCAL_BIN", bin.c_str(), 1);
}

}  // namespace
}  // namespace voqcal
