#include "health/rig_health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

RigHealth::Time At(double time_s) {
  return RigHealth::Time(
      std::chrono::duration_cast<RigHealth::Time::duration>(std::chrono::duration<double>(time_s)));
}

/// A rig whose modules beat each second; a test silences or changes what it is about.
class RigHealthTest : public ::testing::Test {
 protected:
  /// Heartbeats of one second, up to now_s_.
  void Beat() {
    now_s_ += 1;
    ++seq_;
    num_sweeps_ += is_lidar_sending_ ? 10 : 0;
    num_images_ += is_camera_sending_ ? 10 : 0;
    num_lidar_boards_ += is_lidar_sending_ && is_detector_at_work_ ? 10 : 0;
    num_camera_boards_ += is_camera_sending_ ? 10 : 0;
    for (const std::string& module : AllModuleNames()) {
      if (module != silent_) health_.Take(Status(module), At(now_s_));
    }
  }
  void Beat(int num) {
    for (int i = 0; i < num; ++i) Beat();
  }
  module_status_t Status(const std::string& module) const {
    module_status_t status{};
    status.module = module;
    status.seq = seq_;
    status.session = "host:/session";
    status.state = module == "sample_collector" ? collector_state_ : "running";
    if (module == "lidar_driver") status.num_published = num_sweeps_ + seq_;
    if (module == "sample_collector") {
      Add("LIDAR_POINTS", num_sweeps_, 0, &status);
      Add("CAMERA_IMAGE", num_images_, num_lost_, &status);
      Add("LIDAR_BOARD", num_lidar_boards_, 0, &status);
      Add("CAMERA_BOARD", num_camera_boards_, 0, &status);
    }
    return status;
  }
  static void Add(const std::string& name,
                  std::int64_t num_received,
                  std::int64_t num_lost,
                  module_status_t* status) {
    channel_status_t channel{};
    channel.channel = name;
    channel.num_received = num_received;
    channel.num_lost = num_lost;
    channel.rate_hz = num_received > 0 ? 10 : 0;
    status->channels.push_back(channel);
    status->num_channels = static_cast<std::int32_t>(status->channels.size());
  }
  std::vector<Fault> Faults(double later_s = 0) const {
    return health_.Faults(At(now_s_ + later_s));
  }

  RigHealth health_{PlanOfPair({}), {}, At(0)};
  double now_s_ = 0;
  std::int64_t seq_ = 0;
  std::int64_t num_sweeps_ = 0;
  std::int64_t num_images_ = 0;
  std::int64_t num_lidar_boards_ = 0;
  std::int64_t num_camera_boards_ = 0;
  std::int64_t num_lost_ = 0;
  bool is_lidar_sending_ = true;
  bool is_camera_sending_ = true;
  bool is_detector_at_work_ = true;
  std::string silent_;
  std::string collector_state_ = "running: 3 samples";
};

TEST_F(RigHealthTest, ARigThatRunsHasNoFault) {
  Beat(10);
  EXPECT_THAT(Faults(), IsEmpty());
  EXPECT_EQ(health_.FlowOf("LIDAR_POINTS", At(now_s_)), Flow::kFlows);
}

// Two reports of none: at most 2.5 s after the last frame.
TEST_F(RigHealthTest, ASensorThatStopsIsAFaultWithinThreeSecondsAndItsDetectorIsNone) {
  Beat(6);
  is_lidar_sending_ = false;
  Beat();
  EXPECT_THAT(Faults(), IsEmpty());
  Beat();
  EXPECT_THAT(Faults(),
              ElementsAre(AllOf(Field(&Fault::of, "lidar"),
                                Field(&Fault::what, "The lidar has sent nothing for 2 s"),
                                Field(&Fault::cause, "lidar_driver runs, and gets nothing"),
                                Field(&Fault::remedy, HasSubstr("power, cable and address")))));
  is_lidar_sending_ = true;
  Beat();
  EXPECT_THAT(Faults(), IsEmpty());
}

TEST_F(RigHealthTest, ADriverThatHangsIsTheCauseOfItsSensorsSilence) {
  Beat(6);
  is_camera_sending_ = false;
  silent_ = "camera_driver";
  Beat(4);
  EXPECT_THAT(Faults(),
              ElementsAre(AllOf(Field(&Fault::of, "camera"),
                                Field(&Fault::cause, "camera_driver has not answered for 4 s"))));
}

TEST_F(RigHealthTest, ADetectorThatStopsIsAFault) {
  Beat(6);
  is_detector_at_work_ = false;
  Beat(2);
  EXPECT_THAT(Faults(), ElementsAre(Field(&Fault::of, "lidar_board_detector")));
  EXPECT_EQ(health_.FlowOf("LIDAR_BOARD", At(now_s_)), Flow::kSilent);
  EXPECT_EQ(health_.FlowOf("LIDAR_POINTS", At(now_s_)), Flow::kFlows);
}

TEST_F(RigHealthTest, ASlowSensorIsNotSilentBetweenItsFrames) {
  is_camera_sending_ = false;
  for (int i = 0; i < 8; ++i) {  // a frame each three seconds
    num_images_ += 1;
    num_camera_boards_ += 1;
    Beat(3);
  }
  EXPECT_THAT(Faults(), IsEmpty());
  Beat(12);
  EXPECT_THAT(Faults(), ElementsAre(Field(&Fault::of, "camera")));
}

TEST_F(RigHealthTest, ASensorThatNeverSentIsAFaultOnceItsDriverHasStarted) {
  is_lidar_sending_ = false;
  Beat(4);
  EXPECT_THAT(Faults(), IsEmpty());
  Beat();
  EXPECT_THAT(Faults(), ElementsAre(Field(&Fault::what, "The lidar has sent nothing yet")));
}

// Drivers on a host of their own: whether their data arrive is for the other host to say.
TEST_F(RigHealthTest, WithoutAReaderNothingIsSaidOfWhatArrives) {
  const std::vector<std::string> drivers = {"lidar_driver", "camera_driver"};
  RigHealth health{PlanOfPair({}), drivers, At(0)};
  for (int i = 0; i < 20; ++i) {
    Beat();
    for (const std::string& driver : drivers) health.Take(Status(driver), At(now_s_));
  }
  EXPECT_THAT(health.Faults(At(now_s_)), IsEmpty());
}

// Who looks at a session only now knows what its readers have counted.
TEST_F(RigHealthTest, ASensorThatFellSilentBeforeOneLookedIsNotCalledNew) {
  Beat(6);
  is_lidar_sending_ = false;
  Beat(6);
  RigHealth late{PlanOfPair({}), {}, At(now_s_)};
  module_status_t status = Status("sample_collector");
  status.channels[0].rate_hz = 0;
  late.Take(status, At(now_s_));
  late.Take(Status("lidar_driver"), At(now_s_));
  EXPECT_THAT(late.Faults(At(now_s_)),
              ::testing::Contains(Field(&Fault::what, "The lidar has sent nothing lately")));
}

TEST_F(RigHealthTest, ATroubleIsToldInItsModulesWords) {
  collector_state_ = "trouble: The camera's clock is 3600 s ahead; set both by one clock";
  Beat(6);
  EXPECT_THAT(Faults(),
              ElementsAre(AllOf(Field(&Fault::of, "sample_collector"),
                                Field(&Fault::what, "The camera's clock is 3600 s ahead"),
                                Field(&Fault::remedy, "set both by one clock."))));
}

TEST_F(RigHealthTest, AModuleThatFallsSilentIsAFault) {
  Beat(6);
  silent_ = "assessor";
  Beat(4);
  EXPECT_THAT(Faults(),
              ElementsAre(AllOf(Field(&Fault::of, "assessor"),
                                Field(&Fault::cause, "assessor has not answered for 4 s"))));
}

TEST_F(RigHealthTest, ASecondSessionIsAFault) {
  Beat(6);
  module_status_t other = Status("assessor");
  other.session = "host:/other";
  health_.Take(other, At(now_s_));
  EXPECT_THAT(Faults(),
              ElementsAre(Field(&Fault::cause, HasSubstr("host:/other and of host:/session"))));
}

TEST_F(RigHealthTest, WhoOnlyWatchesIsNoSecondSession) {
  Beat(6);
  for (const char* session : {"host:/one", "host:/two"}) {
    module_status_t watcher = Status("extrinsic_monitor");
    watcher.session = session;
    health_.Take(watcher, At(now_s_));
  }
  EXPECT_THAT(Faults(), IsEmpty());
  EXPECT_THAT(health_.heartbeats().Rivals(At(now_s_), "host:/session"), IsEmpty());
}

TEST_F(RigHealthTest, ASessionThatIsAboutToStartIsARivalAndNoModule) {
  Beat(6);
  module_status_t other = Status("assessor");
  other.session = "host:/other";
  other.state = kToBeStarted;
  health_.Take(other, At(now_s_));
  EXPECT_THAT(health_.heartbeats().Rivals(At(now_s_), "host:/session"),
              ElementsAre("assessor of host:/other is about to be started on this network"));
  EXPECT_THAT(health_.heartbeats().Rivals(At(now_s_ + 4), "host:/session"), IsEmpty());
  Beat();
  EXPECT_THAT(Faults(), IsEmpty());
}

// Only sensors come to an end.
TEST_F(RigHealthTest, AReaderThatWasStoppedIsAFault) {
  Beat(6);
  silent_ = "assessor";
  module_status_t status = Status("assessor");
  status.state = "stopped";
  health_.Take(status, At(now_s_));
  EXPECT_THAT(Faults(), ElementsAre(Field(&Fault::cause, "assessor was stopped")));
}

TEST_F(RigHealthTest, LossesAreToldAndAreNoReasonToStop) {
  Beat(6);
  num_lost_ = 5;
  Beat();
  ASSERT_THAT(Faults(), ElementsAre(Field(&Fault::what, "Messages are being lost")));
  EXPECT_FALSE(Faults()[0].is_grave);
  Beat(11);
  EXPECT_THAT(Faults(), ElementsAre(Field(&Fault::what, "Messages were lost")));
}

TEST_F(RigHealthTest, LossesFromBeforeOneLookedAreNotBeingLostNow) {
  num_lost_ = 5;
  Beat();
  EXPECT_THAT(Faults(), ElementsAre(Field(&Fault::what, "Messages were lost")));
}

/// What the host knows while all runs.
SessionFacts Running() {
  SessionFacts facts;
  facts.is_supervised = true;
  facts.num_free_bytes = std::int64_t{10} << 30;
  for (const std::string& module : AllModuleNames()) {
    facts.programs[module].history.is_running = true;
    facts.programs[module].running_s = 60;
  }
  return facts;
}

TEST_F(RigHealthTest, AFullDiskComesFirst) {
  Beat(6);
  silent_ = "assessor";
  Beat(4);
  SessionFacts facts = Running();
  facts.num_free_bytes = 0;
  health_.Take(facts, At(now_s_));
  EXPECT_THAT(Faults(),
              ElementsAre(Field(&Fault::what, "The disk is full"), Field(&Fault::of, "assessor")));
}

TEST_F(RigHealthTest, ADriverThatEndedIsToldAtOnceWithItsLastWords) {
  is_lidar_sending_ = false;
  silent_ = "lidar_driver";
  Beat();
  SessionFacts facts = Running();
  facts.programs["lidar_driver"].history.is_running = false;
  facts.programs["lidar_driver"].history.how_ended = "exit status 1";
  facts.programs["lidar_driver"].last_words = "no_such.pcap: no such file";
  health_.Take(facts, At(now_s_));
  EXPECT_THAT(Faults(),
              ElementsAre(AllOf(Field(&Fault::what, "The lidar has sent nothing yet"),
                                Field(&Fault::cause,
                                      "lidar_driver ended (exit status 1); its last words: "
                                      "no_such.pcap: no such file"))));
}

TEST_F(RigHealthTest, ARecorderThatDiedOrWritesNothingIsAFault) {
  Beat(6);
  SessionFacts facts = Running();
  facts.programs[kRecorder].history.is_running = true;
  facts.num_recorded_bytes = 0;
  health_.Take(facts, At(now_s_));
  EXPECT_THAT(Faults(), IsEmpty());
  Beat(4);
  health_.Take(facts, At(now_s_));
  EXPECT_THAT(Faults(), ElementsAre(Field(&Fault::what, "The recording has not grown for 4 s")));
  facts.programs[kRecorder].history.is_running = false;
  facts.programs[kRecorder].history.how_ended = "exit status 1";
  health_.Take(facts, At(now_s_));
  EXPECT_THAT(Faults(), ElementsAre(Field(&Fault::what, "Nothing is recorded")));
}

TEST_F(RigHealthTest, WhatWasStartedAgainIsTold) {
  Beat(6);
  SessionFacts facts = Running();
  facts.programs["sample_collector"].num_ends_lately = 1;
  facts.programs["sample_collector"].history.how_ended = "terminated by SIGKILL";
  health_.Take(facts, At(now_s_));
  ASSERT_THAT(Faults(), ElementsAre(Field(&Fault::what, "sample_collector was started again")));
  EXPECT_FALSE(Faults()[0].is_grave);
  facts.programs["sample_collector"].num_ends_lately = 5;
  health_.Take(facts, At(now_s_));
  EXPECT_TRUE(Faults()[0].is_grave);
}

TEST_F(RigHealthTest, DriversThatEndedAsPlannedAreNoFault) {
  Beat(6);
  is_lidar_sending_ = is_camera_sending_ = false;
  for (const char* driver : {"lidar_driver", "camera_driver"}) {
    module_status_t status = Status(driver);
    status.state = "done";
    health_.Take(status, At(now_s_));
  }
  EXPECT_THAT(Faults(2.9), IsEmpty());
  EXPECT_EQ(health_.FlowOf("LIDAR_POINTS", At(now_s_ + 2.9)), Flow::kEnded);
}

// Also where only the supervisor's log tells so, to who did not hear its last heartbeat.
TEST_F(RigHealthTest, ADriverThatWasStoppedHasEndedForWhoHeardItAndForWhoDidNot) {
  is_camera_sending_ = false;
  silent_ = "camera_driver";
  Beat(6);
  SessionFacts facts = Running();
  facts.programs["camera_driver"].history.is_running = false;
  facts.programs["camera_driver"].history.was_stopped = true;
  health_.Take(facts, At(now_s_));
  EXPECT_THAT(Faults(), IsEmpty());
  EXPECT_EQ(health_.FlowOf("CAMERA_IMAGE", At(now_s_)), Flow::kEnded);
  EXPECT_EQ(health_.HowEnded("camera_driver"), "stopped");
}

TEST(FaultText, IsOneLine) {
  EXPECT_THAT(ToString(Fault{"disk", "The disk is full", "", "Make room."}),
              StartsWith("The disk is full. Make room."));
}

}  // namespace
}  // namespace voqcal
