// The real processes, live: what they make of the sensors is what calibrate makes of the recording.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "files/atomic_file.hpp"
#include "support/real_data.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

class LiveSession : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.path() / name; }
  std::string Extrinsic(const std::string& session) const {
    return ReadWholeFile(Path(session) + "/extrinsic.yaml");
  }
  void RunRig(const std::string& rig, const std::vector<std::string>& flags) const {
    std::vector<std::string> args = {test::Tool("run_rig"), rig};
    args.insert(args.end(), flags.begin(), flags.end());
    const test::Outcome outcome = test::Run(args);
    ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  }
  void Calibrate(const std::string& rig, const std::string& log, const std::string& out) const {
    const test::Outcome outcome = test::Run(
        {test::Program("calibrate"), "--rig", rig, "--log", Path(log), "--out", Path(out)});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  /// "8 accepted, ...": the last line of the sample collector, without its time.
  std::string CollectorTotals(const std::string& session) const {
    const std::string text = ReadWholeFile(Path(session) + "/sample_collector.txt");
    return text.substr(text.rfind("info: ") + 6);
  }

  test::TemporaryFolder folder_;
};

TEST_F(LiveSession, RecordingAndReplayGiveTheSameBytes) {
  const std::string rig = folder_.Write("rig.yaml", test::ShortRigText());
  ASSERT_NO_FATAL_FAILURE(RunRig(rig, {"--session", Path("live"), "--record"}));
  const std::string live = Extrinsic("live");
  EXPECT_EQ(YAML::Load(live)["samples"]["used"].size(), 8u);  // one of each stop
  for (const char* name : {"offline_1", "offline_2"}) {
    ASSERT_NO_FATAL_FAILURE(Calibrate(rig, "live/raw.lcm", name));
    EXPECT_EQ(Extrinsic(name), live) << name;
  }
  for (const char* name : {"live", "offline_1"}) {
    const std::string again = std::string("again_from_") + name;
    ASSERT_NO_FATAL_FAILURE(Calibrate(rig, std::string(name) + "/samples.lcm", again));
    EXPECT_EQ(Extrinsic(again), live) << name;
  }
  ASSERT_NO_FATAL_FAILURE(
      RunRig(rig, {"--session", Path("replay"), "--replay", Path("live/raw.lcm")}));
  EXPECT_EQ(Extrinsic("replay"), live);
  // The recording also holds what the live modules said: a replay must not say it a second time.
  EXPECT_EQ(CollectorTotals("replay"), CollectorTotals("live"));
}

TEST_F(LiveSession, RealDataReplayedGivesTheSameBytesAsCalibrate) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  const std::string rig = std::string(VOQCAL_SOURCE_DIR) + "/config/rigs/acfr_vlp16.yaml";
  const test::Outcome import = test::Run({test::Program("import_acfr"),
                                          (*data / "acfr-vlp16").string(),
                                          "--rig",
                                          rig,
                                          "--rate",
                                          "3",
                                          "--out",
                                          Path("raw.lcm")});
  ASSERT_EQ(import.status, 0) << import.err;
  ASSERT_NO_FATAL_FAILURE(Calibrate(rig, "raw.lcm", "offline"));
  ASSERT_NO_FATAL_FAILURE(RunRig(rig, {"--session", Path("replay"), "--replay", Path("raw.lcm")}));
  EXPECT_EQ(Extrinsic("replay"), Extrinsic("offline"));
}

}  // namespace
}  // namespace voqcal
