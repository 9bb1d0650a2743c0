#include "calibrate/offline_run.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "support/matchers.hpp"
#include "support/simulated_log.hpp"
#include "support/synthetic_samples.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::SizeIs;

void NoProgress(double /*share*/, std::size_t /*num_samples*/) {}

class OfflineRunTest : public ::testing::Test {
 protected:
  std::filesystem::path session(const std::string& name) const { return folder_.path() / name; }

  test::TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / "raw.lcm";
};

TEST_F(OfflineRunTest, CalibratesATinyLogTwiceToTheSameBytes) {
  const Rig rig = test::TinySimulatedRig();
  test::WriteStopsLog(rig, log_);
  for (const char* name : {"first", "second"}) {
    OfflineRun run(rig, session(name));
    double share = 0;
    run.FeedLog(log_, [&share](double now, std::size_t) { share = now; });
    run.Finish(/*is_collecting_only=*/false);
    EXPECT_EQ(share, 1.0);
    EXPECT_THAT(run.samples(), SizeIs(rig.simulation.num_poses));
    ASSERT_TRUE(run.assessor().result()) << run.assessor().problem();
    // A check of the wiring, not of the method: the stops are few and near. 10 mm of range noise
    // and a degree of a normal, over the lever of a few metres.
    EXPECT_THAT(run.assessor().result()->T_camera_lidar,
                test::IsNear(rig.simulation.T_camera_lidar, 0.02, 0.03));
  }
  EXPECT_EQ(ReadWholeFile(session("first") / kResultName),
            ReadWholeFile(session("second") / kResultName));
}

TEST_F(OfflineRunTest, ChecksTheSceneAndDoesSoAgainFromTheSamplesAlone) {
  const Rig rig = test::TinySimulatedRig();
  test::WriteStopsLog(rig, log_);
  {
    OfflineRun run(rig, session("recording"));
    run.FeedLog(log_, NoProgress);
    run.Finish(/*is_collecting_only=*/false);
    ASSERT_TRUE(run.assessor().result()) << run.assessor().problem();
    EXPECT_EQ(run.assessor().result()->scene_check.num_scenes, rig.simulation.num_poses);
  }
  std::filesystem::create_directory(session("again"));
  std::filesystem::copy_file(session("recording") / kSamplesLogName,
                             session("again") / kSamplesLogName);
  OfflineRun again(rig, session("again"));
  again.Finish(/*is_collecting_only=*/false);
  EXPECT_EQ(ReadWholeFile(session("again") / kResultName),
            ReadWholeFile(session("recording") / kResultName));
}

TEST_F(OfflineRunTest, GoesOnAfterADamagedEventAndSaysSo) {
  const Rig rig = test::TinySimulatedRig();
  test::WriteStopsLog(rig, log_);
  std::string bytes = ReadWholeFile(log_);
  const std::size_t second = bytes.find("\xED\xA1\xDA\x01", 4);
  bytes.replace(second, 4, "????");
  folder_.Write("raw.lcm", bytes);
  OfflineRun run(rig, session("s"));
  run.FeedLog(log_, NoProgress);
  run.Finish(/*is_collecting_only=*/true);
  EXPECT_EQ(run.Losses(), "1 damaged places");
  // The first image is gone, and so the first stop.
  EXPECT_THAT(run.samples(), SizeIs(rig.simulation.num_poses - 1));
}

// In the sync word and before its last byte: the same as if it had not begun.
TEST_F(OfflineRunTest, LeavesOutAnEventThatTheEndCutsOffAndSaysSo) {
  const Rig rig = test::TinySimulatedRig();
  test::WriteStopsLog(rig, log_);
  const std::string whole = ReadWholeFile(log_);
  const std::size_t last = whole.rfind("\xED\xA1\xDA\x01");
  for (const std::size_t num_bytes : {std::size_t{2}, whole.size() - last - 1}) {
    folder_.Write("raw.lcm", whole.substr(0, last + num_bytes));
    OfflineRun run(rig, session(std::to_string(num_bytes)));
    run.FeedLog(log_, NoProgress);
    run.Finish(/*is_collecting_only=*/true);
    EXPECT_EQ(run.Losses(),
              "cut off within an event, " + std::to_string(num_bytes) + " bytes left out");
    EXPECT_THAT(run.samples(), SizeIs(rig.simulation.num_poses - 1));
  }
}

TEST_F(OfflineRunTest, CollectsOnlyIfAsked) {
  OfflineRun run(test::TinySimulatedRig(), session("s"));
  run.FeedSamples(test::SynthesizeSamples({}));
  run.Finish(/*is_collecting_only=*/true);
  EXPECT_THAT(run.samples(), SizeIs(30));
  EXPECT_FALSE(run.assessor().result());
  EXPECT_FALSE(std::filesystem::exists(session("s") / kResultName));
}

TEST_F(OfflineRunTest, SaysWhyThereIsNoResult) {
  test::SyntheticSamplesOptions two;
  two.num_samples = 2;
  OfflineRun run(test::TinySimulatedRig(), session("s"));
  run.FeedSamples(test::SynthesizeSamples(two));
  run.Finish(/*is_collecting_only=*/false);
  EXPECT_FALSE(run.assessor().result());
  EXPECT_THAT(run.assessor().problem(), HasSubstr("fewer than three samples"));
}

TEST_F(OfflineRunTest, NamesTheChannelThatALogHasNot) {
  LogWriter(log_).Write({0, 0, "POSE", {1, 2, 3}});
  OfflineRun run(test::TinySimulatedRig(), session("s"));
  EXPECT_THAT(test::ErrorOf([&] { run.FeedLog(log_, NoProgress); }),
              AllOf(HasSubstr(log_.string()),
                    HasSubstr("no channel LIDAR_POINTS"),
                    HasSubstr("it has POSE")));
}

TEST_F(OfflineRunTest, CountsImagesOfAnotherSize) {
  Rig other = test::TinySimulatedRig();
  test::WriteStopsLog(other, log_);
  other.camera.width_px += 2;
  OfflineRun run(other, session("s"));
  run.FeedLog(log_, NoProgress);
  run.Finish(/*is_collecting_only=*/false);
  EXPECT_THAT(run.samples(), SizeIs(0));
  const std::vector<const Module*> modules = run.modules();
  const auto detector = std::find_if(modules.begin(), modules.end(), [](const Module* module) {
    return module->Name() == "camera_board_detector";
  });
  ASSERT_NE(detector, modules.end());
  EXPECT_THAT((*detector)->counters(), ElementsAre(Pair(HasSubstr("the camera's are"), Gt(0))));
}

TEST_F(OfflineRunTest, TellsASessionsLogFromARecording) {
  {
    OfflineRun run(test::TinySimulatedRig(), session("s"));
    run.FeedSamples(test::SynthesizeSamples({}));
  }
  LogWriter(log_).Write({0, 0, "LIDAR_POINTS", {1, 2, 3}});
  EXPECT_TRUE(IsSamplesLog(test::TinySimulatedRig(), session("s") / kSamplesLogName));
  EXPECT_FALSE(IsSamplesLog(test::TinySimulatedRig(), log_));
  std::filesystem::resize_file(log_, 20);  // within its first event
  EXPECT_FALSE(IsSamplesLog(test::TinySimulatedRig(), log_));
}

}  // namespace
}  // namespace voqcal
