// A recording of ROS gives the very result of the log that it was made from.

#include <filesystem>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "files/atomic_file.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/encode.hpp"
#include "messaging/log.hpp"
#include "rig/rig.hpp"
#include "support/sanitizers.hpp"
#include "support/simulated_log.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

constexpr char kToRecording[] = VOQCAL_SOURCE_DIR "/test/system/log_to_recording.mjs";

bool HasNode() {
  return std::filesystem::exists(VOQCAL_SOURCE_DIR "/tools/node/node_modules") &&
         test::Run({"sh", "-c", "command -v node"}).status == 0;
}

class ImportRos : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasNode()) GTEST_SKIP() << "without Node.js or its packages: tools/setup installs them";
  }

  std::string Path(const std::string& name) const { return folder_.path() / name; }

  void MustRun(const std::vector<std::string>& args) const {
    const test::Outcome outcome = test::Run(args);
    ASSERT_EQ(outcome.status, 0) << args[0] << ": " << outcome.err;
  }

  /// All of extrinsic.yaml but the hash of the samples: they hold the sweeps, whose fields are laid
  /// out as the recording has them.
  std::string ResultOf(const std::string& log, const std::string& flag = "--log") const {
    MustRun({test::Program("calibrate"), "--rig", rig_, flag, log, "--out", log + ".out"});
    const std::string text = ReadWholeFile(log + ".out/extrinsic.yaml");
    const std::size_t hash = text.find("\n  log_sha256:") + 1;
    return text.substr(0, hash) + text.substr(text.find('\n', hash));
  }

  test::TemporaryFolder folder_;
  std::string rig_ = folder_.Write(
      "rig.yaml",
      test::Replaced(test::ShortRigText(), "num_still_frames: 3", "num_still_frames: 1"));
};

class ImportRosKinds : public ImportRos, public ::testing::WithParamInterface<const char*> {};

TEST_P(ImportRosKinds, GivesTheResultOfTheLog) {
  test::WriteStopsLog(LoadRig(rig_), Path("raw.lcm"));
  const std::string recording = Path(std::string("raw.") + GetParam());
  MustRun({"node", kToRecording, Path("raw.lcm"), recording});
  MustRun({test::Tool("import_ros"),
           recording,
           "--lidar-topic",
           "/velodyne_points",
           "--image-topic",
           "/camera/image",
           "--out",
           Path("imported.lcm")});
  EXPECT_EQ(ResultOf(Path("imported.lcm")), ResultOf(Path("raw.lcm")));
}

INSTANTIATE_TEST_SUITE_P(Kinds,
                         ImportRosKinds,
                         ::testing::Values("bag", "mcap"),
                         [](const auto& kind) { return std::string(kind.param); });

/// The log with its images as grey pixels.
void WriteGreyLog(const Rig& rig, const std::string& from, const std::string& to) {
  LogReader reader(from);
  LogWriter writer(to);
  while (std::optional<LogEvent> event = reader.Next()) {
    if (event->channel == rig.channels.camera_image) {
      image_t message;
      ASSERT_EQ(DecodeMessage(event->bytes.data(), event->bytes.size(), &message), "");
      cv::Mat image = FromMessage(message);
      if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
      event->bytes = EncodeMessage(ToMessage(image, message.utime, event->number));
    }
    writer.Write(*event);
  }
}

TEST_F(ImportRos, GivesTheResultOfTheLogWithEachEncodingThatLosesNothing) {
  VOQCAL_LEAVE_TO_RELEASE();
  const Rig rig = LoadRig(rig_);
  test::WriteStopsLog(rig, Path("jpeg.lcm"));
  WriteGreyLog(rig, Path("jpeg.lcm"), Path("raw.lcm"));
  const std::string expected = ResultOf(Path("raw.lcm"));
  for (const char* encoding : {"mono8", "bgr8", "rgba8", "mono16", "yuv422", "yuv422_yuy2"}) {
    MustRun({"node", kToRecording, Path("raw.lcm"), Path("raw.mcap"), encoding});
    EXPECT_EQ(ResultOf(Path("raw.mcap"), "--bag"), expected) << encoding;
  }
}

TEST_F(ImportRos, GivesTheResultOfTheLogInParts) {
  VOQCAL_LEAVE_TO_RELEASE();
  test::WriteStopsLog(LoadRig(rig_), Path("raw.lcm"));
  std::filesystem::create_directory(Path("parts"));
  MustRun({"node", kToRecording, Path("raw.lcm"), Path("parts")});
  EXPECT_EQ(ResultOf(Path("parts"), "--bag"), ResultOf(Path("raw.lcm")));
}

// The log's own types are read by --bag as well.
TEST_F(ImportRos, GivesTheResultOfTheLogFromTheLog) {
  VOQCAL_LEAVE_TO_RELEASE();
  test::WriteStopsLog(LoadRig(rig_), Path("raw.lcm"));
  const std::string expected = ResultOf(Path("raw.lcm"));
  EXPECT_EQ(ResultOf(Path("raw.lcm"), "--bag"), expected);
}

TEST_F(ImportRos, IsDoneByCalibrateItself) {
  test::WriteStopsLog(LoadRig(rig_), Path("raw.lcm"));
  MustRun({"node", kToRecording, Path("raw.lcm"), Path("raw.db3")});
  EXPECT_EQ(ResultOf(Path("raw.db3"), "--bag"), ResultOf(Path("raw.lcm")));
}

}  // namespace
}  // namespace voqcal
