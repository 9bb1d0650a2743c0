// A replay in which messages are lost says how many, and who lost them, and still ends in a result.

#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "files/atomic_file.hpp"
#include "messaging/log.hpp"
#include "rig/rig.hpp"
#include "support/simulated_log.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

class LostMessages : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.path() / name; }

  /// One frame of each stop more than a sample needs.
  void SetUp() override {
    Rig rig = LoadRig(rig_);
    rig.sample_collector.num_still_frames = 4;
    test::WriteStopsLog(rig, Path("whole.lcm"));
  }

  test::Outcome Replay(const std::string& log, const std::string& speed) const {
    return test::Run({test::Tool("run_rig"),
                      rig_,
                      "--session",
                      Path("session"),
                      "--replay",
                      log,
                      "--speed",
                      speed});
  }

  /// The session's result is near the truth: 8 samples of a camera of half the size and one pixel
  /// of error each would be off by 0.15 deg / sqrt(8) and, 3 m away, 8 mm / sqrt(8); allow 5x.
  void ExpectNearTruth() const {
    const test::Outcome compare = test::Run({test::Program("compare"),
                                             Path("session/extrinsic.yaml"),
                                             "--truth-of",
                                             rig_,
                                             "--max-rotation-deg",
                                             "0.27",
                                             "--max-translation-mm",
                                             "14"});
    EXPECT_EQ(compare.status, 0) << compare.out << compare.err;
  }

  test::TemporaryFolder folder_;
  std::string rig_ = folder_.Write("rig.yaml", test::ShortRigText());
};

/// Copies a log without one event in twenty, by chance.
/// @return for each channel, how many are gone between the first and the last that are left.
std::map<std::string, int> DropOneInTwenty(const std::string& from, const std::string& to) {
  std::mt19937 random(3);
  std::map<std::string, int> num_lost;
  std::map<std::string, int> num_dropped_since_kept;
  LogReader reader(from);
  LogWriter writer(to);
  while (const auto event = reader.Next()) {
    if (random() % 20 == 0) {
      ++num_dropped_since_kept[event->channel];
      continue;
    }
    writer.Write(*event);
    const bool is_first = num_lost.count(event->channel) == 0;
    num_lost[event->channel] += is_first ? 0 : num_dropped_since_kept[event->channel];
    num_dropped_since_kept[event->channel] = 0;
  }
  return num_lost;
}

TEST_F(LostMessages, OneInTwentyIsCountedByTheReadersAndTheResultIsStillRight) {
  std::map<std::string, int> num_lost = DropOneInTwenty(Path("whole.lcm"), Path("lossy.lcm"));
  ASSERT_GT(num_lost["LIDAR_POINTS"], 0);
  ASSERT_GT(num_lost["CAMERA_IMAGE"], 0);
  const test::Outcome replay = Replay(Path("lossy.lcm"), "1");
  ASSERT_EQ(replay.status, 0) << replay.out << replay.err;
  for (const auto& [module, channel] : {std::pair("lidar_board_detector", "LIDAR_POINTS"),
                                        std::pair("camera_board_detector", "CAMERA_IMAGE")}) {
    const std::string lost =
        std::string(module) + ": " + std::to_string(num_lost[channel]) + " of ";
    EXPECT_THAT(replay.out, HasSubstr(lost)) << channel;
  }
  ExpectNearTruth();
}

TEST_F(LostMessages, AReplayAsFastAsItIsReadLosesNothing) {
  const test::Outcome replay = Replay(Path("whole.lcm"), "0");
  ASSERT_EQ(replay.status, 0) << replay.out << replay.err;
  EXPECT_THAT(replay.out, HasSubstr("lost    nothing"));
  const test::Outcome offline = test::Run({test::Program("calibrate"),
                                           "--rig",
                                           rig_,
                                           "--log",
                                           Path("whole.lcm"),
                                           "--out",
                                           Path("offline")});
  ASSERT_EQ(offline.status, 0) << offline.err;
  EXPECT_EQ(ReadWholeFile(Path("session/extrinsic.yaml")),
            ReadWholeFile(Path("offline/extrinsic.yaml")));
}

}  // namespace
}  // namespace voqcal
