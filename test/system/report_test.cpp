// report.html and result.json of a simulated run and of the real session, as a browser shows them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "files/atomic_file.hpp"
#include "rig/rig.hpp"
#include "support/real_data.hpp"
#include "support/simulated_log.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kInBrowser[] = VOQCAL_SOURCE_DIR "/test/system/report_in_browser.mjs";
constexpr char kWithNode[] = VOQCAL_SOURCE_DIR "/test/system/with_node.sh";
constexpr int kSkipped = 77;

class Report : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.path() / name; }

  void Calibrate(const std::string& rig, const std::string& log, const std::string& out) const {
    const test::Outcome outcome =
        test::Run({test::Program("calibrate"), "--rig", rig, "--log", log, "--out", Path(out)});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("report")));
  }

  /// No console error, no request, no broken picture, nothing wider than the screen.
  void ExpectGoodInBrowser(const std::string& out) const {
    const test::Outcome outcome =
        test::Run({kWithNode, "node", kInBrowser, Path(out + "/report.html")});
    if (outcome.status == kSkipped) GTEST_SKIP() << outcome.out;
    EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  }

  test::TemporaryFolder folder_;
};

// Two stops are too few: the page shows what was seen instead.
TEST_F(Report, OfAFailureShowsWhatWasSeen) {
  const std::string rig = folder_.Write(
      "rig.yaml", test::Replaced(test::ShortRigText(), "\n  num_poses: 8", "\n  num_poses: 2"));
  test::WriteStopsLog(LoadRig(rig), Path("raw.lcm"));
  const std::string other = folder_.Write(  // a board that is not there
      "other.yaml",
      test::Replaced(ReadWholeFile(rig), "\n  num_corners_x: 5", "\n  num_corners_x: 3"));
  const auto calibrate = [this](const std::string& rig_file, const std::string& out) {
    return test::Run({test::Program("calibrate"),
                      "--rig",
                      rig_file,
                      "--log",
                      Path("raw.lcm"),
                      "--out",
                      Path(out)});
  };
  const test::Outcome few = calibrate(rig, "few");
  EXPECT_EQ(few.status, 1);
  EXPECT_THAT(few.err, HasSubstr("what was seen: " + Path("few/no_result.html")));
  EXPECT_THAT(test::NamesIn(Path("few")), ::testing::ElementsAre("no_result.html"));
  EXPECT_THAT(ReadWholeFile(Path("few/no_result.html")),
              AllOf(HasSubstr("Sample 1"), HasSubstr("Sample 2"), HasSubstr("data:image/jpeg")));

  EXPECT_EQ(calibrate(other, "none").status, 1);
  const std::string none = ReadWholeFile(Path("none/no_result.html"));
  EXPECT_THAT(none,
              AllOf(HasSubstr("<h3>Camera: "),
                    HasSubstr("num_corners_x"),
                    HasSubstr("data:image/jpeg"),
                    Not(HasSubstr("Sample 1"))));
  const test::Outcome outcome =
      test::Run({kWithNode, "node", kInBrowser, Path("none/no_result.html")});
  if (outcome.status == kSkipped) GTEST_SKIP() << outcome.out;
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

// A camera that never came, say.
TEST_F(Report, OfASessionWithoutASampleSaysSo) {
  const std::string rig = folder_.Write("rig.yaml", test::ShortRigText());
  folder_.Write("samples.lcm", "");
  const test::Outcome outcome = test::Run({test::Program("report"), folder_.path(), "--rig", rig});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no calibration: no sample was taken"));
  EXPECT_THAT(ReadWholeFile(Path("no_result.html")), HasSubstr("No sample was taken"));
}

class SimulatedReport : public Report {
 protected:
  void SetUp() override {
    test::WriteStopsLog(LoadRig(rig_), Path("raw.lcm"));
    Calibrate(rig_, Path("raw.lcm"), "out");
  }

  std::string rig_ = folder_.Write(
      "rig.yaml",
      test::Replaced(test::ShortRigText(), "num_still_frames: 3", "num_still_frames: 1"));
};

TEST_F(SimulatedReport, IsGoodInABrowser) { ExpectGoodInBrowser("out"); }

TEST_F(SimulatedReport, IsTheSameEachTime) {
  Calibrate(rig_, Path("raw.lcm"), "again");
  for (const char* name : {"/report.html", "/result.json"}) {
    EXPECT_EQ(ReadWholeFile(Path("out") + name), ReadWholeFile(Path("again") + name)) << name;
  }
}

TEST_F(SimulatedReport, IsTheSameWhateverPythonsTheUserHas) {
  folder_.Write("jinja2.py", "raise ImportError('not the one')");
  const test::Outcome outcome = test::Run({"/usr/bin/env",
                                           "PYTHONPATH=" + folder_.path().string(),
                                           "PYTHONHOME=/nowhere",
                                           test::Program("calibrate"),
                                           "--rig",
                                           rig_,
                                           "--log",
                                           Path("raw.lcm"),
                                           "--out",
                                           Path("again")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(ReadWholeFile(Path("again/report.html")), ReadWholeFile(Path("out/report.html")));
}

TEST_F(SimulatedReport, OfSamplesThatContradictOneAnotherPointsAtThem) {
  const std::string rig = folder_.Write(
      "squares.yaml", test::Replaced(ReadWholeFile(rig_), "square_m: 0.095", "square_m: 0.0095"));
  const test::Outcome outcome = test::Run({test::Program("calibrate"),
                                           "--rig",
                                           rig,
                                           "--log",
                                           Path("raw.lcm"),
                                           "--out",
                                           Path("squares")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(ReadWholeFile(Path("squares/no_result.html")),
              AllOf(HasSubstr("counts are kept where fewer than three are"),
                    HasSubstr("give board.square_m: 0.095"),
                    Not(HasSubstr("Not available"))));
}

// A script that copies the result onto a robot can stop by itself.
TEST_F(SimulatedReport, AResultThatIsWorseThanRequiredIsWrittenAndIsAnExitStatus) {
  const test::Outcome outcome = test::Run({test::Program("calibrate"),
                                           "--rig",
                                           rig_,
                                           "--log",
                                           Path("raw.lcm"),
                                           "--out",
                                           Path("required"),
                                           "--require",
                                           "usable"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.out, HasSubstr("Do not use it"));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("Do not use it"), HasSubstr("--require")));
  for (const char* name : {"/report.html", "/extrinsic.yaml"}) {
    EXPECT_EQ(ReadWholeFile(Path("out") + name), ReadWholeFile(Path("required") + name)) << name;
  }
}

// By make_report.py alone, without pictures.
TEST_F(SimulatedReport, IsTheSameWithoutTheTemplatesCode) {
  const std::string built = test::Program("../lib/report.html.j2.code");
  const std::string cut = folder_.Write("cut.code", ReadWholeFile(built).substr(0, 1000));
  const auto page = [this](const std::string& code) {
    const test::Outcome outcome = test::Run({test::Tool("report/make_report.py"),
                                             Path("out/result.json"),
                                             folder_.path().string(),
                                             Path("page.html"),
                                             code});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return ReadWholeFile(Path("page.html"));
  };
  const std::string by_code = page(built);
  EXPECT_EQ(page(Path("none")), by_code);
  EXPECT_EQ(page(cut), by_code);
}

TEST_F(SimulatedReport, HasAPictureOfEachSample) {
  const std::string page = ReadWholeFile(Path("out/report.html"));
  const auto json = nlohmann::json::parse(ReadWholeFile(Path("out/result.json")));
  ASSERT_FALSE(json["samples"].empty());
  for (const auto& sample : json["samples"]) {
    EXPECT_THAT(page, HasSubstr("Pose " + sample["id"].dump() + ": the image with the lidar"));
  }
}

/// The picture before its description, as the page holds it.
std::string PictureBefore(const std::string& description, const std::string& page) {
  const std::size_t end = page.find(description);
  const std::size_t start = page.rfind("data:image/jpeg;base64,", end);
  if (end == std::string::npos || start == std::string::npos) return "";
  return page.substr(start, page.find('"', start) - start);
}

TEST_F(SimulatedReport, HasOneCloudInTheImagesColoursByTheResultAndByAWrongOne) {
  const std::string page = ReadWholeFile(Path("out/report.html"));
  EXPECT_THAT(page, HasSubstr("is nearest to the median distance"));
  const std::string right =
      PictureBefore("the lidar's points in the image's colours by the refined extrinsic", page);
  const std::string wrong = PictureBefore("The same by an extrinsic that is turned", page);
  EXPECT_GT(right.size(), 10000U);
  EXPECT_GT(wrong.size(), 10000U);
  EXPECT_TRUE(right != wrong);  // not EXPECT_NE, which would print both
}

TEST_F(SimulatedReport, JsonSaysWhatTheResultSays) {
  const auto json = nlohmann::json::parse(ReadWholeFile(Path("out/result.json")));
  const std::string yaml = ReadWholeFile(Path("out/extrinsic.yaml"));
  for (const char* key : {"T_camera_lidar", "covariance", "averaged", "scores", "made_from"}) {
    EXPECT_TRUE(json["result"].contains(key)) << key;
  }
  EXPECT_THAT(yaml, HasSubstr(json["result"]["made_from"]["log_sha256"].get<std::string>()));
  EXPECT_THAT(ReadWholeFile(Path("out/report.html")),
              HasSubstr(json["verdict"]["headline"].get<std::string>()));
  EXPECT_EQ(json["sets"]["chosen"].size(),
            json["result"]["averaged"]["num_sets"].get<std::size_t>());
  const auto& all_voq = json["sets"]["all_voq"];
  std::size_t num_sets = 0;
  for (const auto& count : all_voq["counts"]) num_sets += count.get<std::size_t>();
  const std::size_t n = json["result"]["samples"]["used"].size();
  EXPECT_EQ(num_sets, n * (n - 1) * (n - 2) / 6);
}

TEST_F(SimulatedReport, JsonCanBePrinted) {
  const test::Outcome outcome = test::Run({test::Program("calibrate"),
                                           "--rig",
                                           rig_,
                                           "--log",
                                           Path("raw.lcm"),
                                           "--out",
                                           Path("printed"),
                                           "--json"});
  EXPECT_EQ(outcome.out, ReadWholeFile(Path("printed/result.json")));
}

TEST_F(SimulatedReport, OfALiveSessionIsThatOfCalibrate) {
  std::filesystem::create_directory(Path("session"));
  std::filesystem::copy_file(Path("out/samples.lcm"), Path("session/samples.lcm"));
  const test::Outcome outcome =
      test::Run({test::Program("report"), Path("session"), "--rig", rig_});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  Calibrate(rig_, Path("out/samples.lcm"), "from_samples");
  EXPECT_EQ(ReadWholeFile(Path("session/report.html")),
            ReadWholeFile(Path("from_samples/report.html")));
}

// They hold the board's pose by the camera that they were taken with: another would change nothing.
TEST_F(SimulatedReport, SamplesOfAnotherCameraGiveNone) {
  const std::string other =
      folder_.Write("other.yaml", test::Replaced(ReadWholeFile(rig_), "fx_px: 375", "fx_px: 340"));
  const test::Outcome outcome = test::Run({test::Program("calibrate"),
                                           "--rig",
                                           other,
                                           "--log",
                                           Path("out/samples.lcm"),
                                           "--out",
                                           Path("other")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("samples.lcm"), HasSubstr("other intrinsics")));
  EXPECT_FALSE(std::filesystem::exists(Path("other")));
}

TEST_F(Report, OfTheRealSessionIsGoodInABrowser) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  const std::string rig = VOQCAL_SOURCE_DIR "/config/rigs/acfr_vlp16.yaml";
  const std::string session = *data / "acfr-vlp16";
  const test::Outcome import =
      test::Run({test::Program("import_acfr"), session, "--rig", rig, "--out", Path("raw.lcm")});
  ASSERT_EQ(import.status, 0) << import.err;
  Calibrate(rig, Path("raw.lcm"), "out");
  ExpectGoodInBrowser("out");
}

}  // namespace
}  // namespace voqcal
