// A recording of ROS gives the very result of the log that it was made from.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "rig/rig.hpp"
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
           "/camera/image/compressed",
           "--out",
           Path("imported.lcm")});
  EXPECT_EQ(ResultOf(Path("imported.lcm")), ResultOf(Path("raw.lcm")));
}

INSTANTIATE_TEST_SUITE_P(Kinds,
                         ImportRosKinds,
                         ::testing::Values("bag", "mcap"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_F(ImportRos, IsDoneByCalibrateItself) {
  test::WriteStopsLog(LoadRig(rig_), Path("raw.lcm"));
  MustRun({"node", kToRecording, Path("raw.lcm"), Path("raw.db3")});
  EXPECT_EQ(ResultOf(Path("raw.db3"), "--bag"), ResultOf(Path("raw.lcm")));
}

}  // namespace
}  // namespace voqcal
