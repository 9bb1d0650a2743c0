// A rig of several sensors, live: two simulated lidars and three cameras in one world.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "support/sanitizers.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

class LiveRig : public ::testing::Test {
 protected:
  ~LiveRig() override { Down(); }

  test::Outcome Up(const std::string& rig, const std::vector<std::string>& flags = {}) const {
    std::vector<std::string> args = {test::Tool("up"), rig, "--session", session_};
    args.insert(args.end(), flags.begin(), flags.end());
    return test::Run(args);
  }
  test::Outcome Down() const { return test::Run({test::Tool("down"), "--session", session_}); }

  test::TemporaryFolder folder_;
  std::string rig_ = folder_.Write("rig.yaml", test::SmallRigOfSeveralText());
  std::string session_ = folder_.path() / "session";
};

TEST_F(LiveRig, RunsTheSensorsThatAreNamedAndThoseOfThemThatAreWanted) {
  const std::string some = rig_ + "#roof,front,rear";
  const test::Outcome up =
      Up(some, {"--only", "sample_collector,rig_calibrator,camera_board_detector_rear"});
  ASSERT_EQ(up.status, 0) << up.err;
  EXPECT_THAT(up.out, HasSubstr("running: 4 programs"));
  EXPECT_THAT(ReadWholeFile(session_ + "/rig.yaml"), HasSubstr("\nsensors: roof,front,rear\n"));
  EXPECT_THAT(test::NamesIn(session_),
              AllOf(Contains("roof_front"), Contains("roof_rear"), Not(Contains("roof_left"))));

  const test::Outcome status = test::Run({test::Tool("status"),
                                          session_ + "/rig.yaml",
                                          "--once",
                                          "--modules",
                                          "sample_collector_roof_rear,rig_calibrator"});
  EXPECT_EQ(status.status, 0) << status.out << status.err;
  EXPECT_THAT(status.out,
              AllOf(HasSubstr("camera_board_detector_rear "),
                    HasSubstr("roof_rear        0"),
                    HasSubstr("no pair joins these parts of the rig: roof | front | rear")));
  // A pair of them would hear the same commands.
  const test::Outcome pair = test::Run({test::Tool("up"),
                                        rig_ + "#roof,front",
                                        "--session",
                                        session_ + "2",
                                        "--only",
                                        "sample_collector"});
  EXPECT_EQ(pair.status, 1);
  EXPECT_THAT(pair.err, HasSubstr("sample_collector_roof_"));
  EXPECT_EQ(Down().status, 0);
}

TEST_F(LiveRig, WhatCannotBeEndsInALine) {
  const auto error_of = [this](const std::string& rig, const std::vector<std::string>& flags = {}) {
    const test::Outcome up = Up(rig, flags);
    EXPECT_NE(up.status, 0);
    EXPECT_EQ(std::count(up.err.begin(), up.err.end(), '\n'), 1) << up.err;
    return up.err;
  };
  EXPECT_THAT(error_of(rig_ + "#roof,fornt,left"),
              HasSubstr("has no sensor 'fornt' (did you mean front?)"));
  EXPECT_THAT(error_of(rig_, {"--only", "lidar_driver_rof"}),
              HasSubstr("no module 'lidar_driver_rof'"));
  const std::string text = test::SmallRigOfSeveralText();
  const std::string one_channel = folder_.Write(
      "one_channel.yaml",
      test::Replaced(
          text, "  left:\n", "  left:\n    channels: {camera_image: CAMERA_IMAGE_front}\n"));
  EXPECT_THAT(error_of(one_channel), HasSubstr("cameras.left.channels.camera_image must differ"));
  const std::string two_worlds =
      folder_.Write("two_worlds.yaml", test::Replaced(text, "pattern: vlp16", "seed: 2"));
  EXPECT_THAT(error_of(two_worlds), HasSubstr("lidars.bumper.simulation.seed is not a known key"));
  EXPECT_THAT(test::NamesIn(folder_.path()), Not(Contains("session")));
  const auto error_of_calibrator = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), test::Program("rig_calibrator"));
    const test::Outcome outcome = test::Run(arguments);
    EXPECT_EQ(outcome.status, 1);
    return outcome.err;
  };
  EXPECT_THAT(error_of_calibrator({"--rig", rig_ + "#roof,left", "--session", session_}),
              HasSubstr("is one pair, whose own modules calibrate it"));
  EXPECT_THAT(error_of_calibrator({"--rig", rig_}), HasSubstr("--session is missing"));
}

// Of an undisturbed session, of one whose calibrator is killed and of one that loses a detector or
// a collector. More of them: test/system/kill_test.py by hand.
TEST_F(LiveRig, EndsWithTheBytesThatItsRecordingGives) {
  VOQCAL_LEAVE_TO_RELEASE();
  const test::Outcome outcome =
      test::Run({std::string(VOQCAL_SOURCE_DIR) + "/test/system/kill_test.py",
                 rig_,
                 "--out",
                 folder_.path() / "kills",
                 "--kills",
                 "2"});
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace voqcal
