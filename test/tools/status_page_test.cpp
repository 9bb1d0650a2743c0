#include "rig_status/status_page.hpp"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Health = ModuleHealth;

StatusPage::Time At(double time_s) {
  return StatusPage::Time(std::chrono::duration_cast<StatusPage::Time::duration>(
      std::chrono::duration<double>(time_s)));
}

module_status_t Status(const std::string& module, std::int64_t seq, const std::string& state) {
  module_status_t status{};
  status.module = module;
  status.seq = seq;
  status.state = state;
  return status;
}

channel_status_t Channel(const std::string& name,
                         std::int64_t num_received,
                         std::int64_t num_lost) {
  channel_status_t channel{};
  channel.channel = name;
  channel.num_received = num_received;
  channel.num_lost = num_lost;
  channel.rate_hz = 10;
  return channel;
}

void AddChannel(const channel_status_t& channel, module_status_t* status) {
  status->channels.push_back(channel);
  status->num_channels = static_cast<std::int32_t>(status->channels.size());
}

void AddCounter(const std::string& name, std::int64_t count, module_status_t* status) {
  counter_t counter{};
  counter.name = name;
  counter.count = count;
  status->counters.push_back(counter);
  status->num_counters = static_cast<std::int32_t>(status->counters.size());
}

module_status_t StatusOf(const std::string& session, std::int64_t seq) {
  module_status_t status = Status("assessor", seq, "running");
  status.session = session;
  return status;
}

TEST(StatusPage, NamesTwoSessionsThatRunTheSameModule) {
  StatusPage page(PlanOfPair({}), {"assessor"}, At(0));
  page.Take(StatusOf("a:/one", 7), At(0));
  EXPECT_THAT(page.health().heartbeats().Rivals(At(0)), IsEmpty());
  EXPECT_THAT(page.health().heartbeats().Rivals(At(0), "a:/one"), IsEmpty());
  EXPECT_THAT(page.health().heartbeats().Rivals(At(0), "b:/two"),
              ElementsAre("assessor of a:/one runs on this network"));
  page.Take(StatusOf("b:/two", 2), At(1));
  EXPECT_THAT(page.health().heartbeats().Rivals(At(1)),
              ElementsAre("assessor of a:/one and of b:/two runs on this network"));
  EXPECT_FALSE(page.IsAllGood(At(1)));
  EXPECT_THAT(page.Text(At(1)),
              HasSubstr("WRONG   Two sessions run on one network: assessor of a:/one and"));
  EXPECT_THAT(page.Text(At(1)), Not(HasSubstr("restarted")));
  page.Take(StatusOf("b:/two", 6), At(5));
  EXPECT_TRUE(page.IsAllGood(At(5)));  // the first is gone
}

// tools/up --only: the others may be another host's.
TEST(StatusPage, WhatWasNotStartedHereIsNoFaultUnlessSomethingIsWaitedFor) {
  StatusPage page(PlanOfPair({}), {}, At(0));
  SessionFacts facts;
  facts.is_supervised = true;
  facts.programs["assessor"].history.is_running = true;
  page.Take(facts, At(0));
  page.Take(Status("assessor", 7, "running"), At(9));
  EXPECT_TRUE(page.IsAllGood(At(9))) << page.Text(At(9));
  EXPECT_THAT(page.Text(At(9)), ContainsRegex("pose_guide +not started here, not heard\n"));
  EXPECT_THAT(page.Text(At(9)), HasSubstr("silent  nobody"));

  facts.programs["lidar_board_detector"].history.is_running = true;
  page.Take(facts, At(9));
  module_status_t detector = Status("lidar_board_detector", 7, "running");
  channel_status_t nothing = Channel("LIDAR_POINTS", 0, 0);
  nothing.rate_hz = 0;
  AddChannel(nothing, &detector);
  page.Take(detector, At(9));
  EXPECT_FALSE(page.IsAllGood(At(9)));
  EXPECT_THAT(page.Text(At(9)),
              HasSubstr("The lidar has sent nothing yet: lidar_driver was not started here, and is "
                        "not heard\n        Start it too (tools/up --only lidar_driver), on its "
                        "host."));
}

TEST(StatusPage, LossesAreNotGood) {
  StatusPage page(PlanOfPair({}), {"assessor"}, At(0));
  module_status_t status = Status("assessor", 1, "running");
  AddChannel(Channel("CALIB_SAMPLES", 9, 1), &status);
  page.Take(status, At(0));
  EXPECT_FALSE(page.IsAllGood(At(0)));
}

TEST(StatusPage, NamesWhoWasNeverHeard) {
  StatusPage page(PlanOfPair({}), {"lidar_driver", "assessor"}, At(0));
  page.Take(Status("assessor", 1, "running"), At(0));
  EXPECT_FALSE(page.IsAllGood(At(0)));
  EXPECT_THAT(page.Text(At(0)),
              AllOf(HasSubstr("lidar_driver           not heard\n"),
                    HasSubstr("\nsilent  lidar_driver\n"),
                    HasSubstr("\nlost    nothing\n")));
}

TEST(StatusPage, ADriverThatEndedBeforeAnyoneListenedIsNotSilent) {
  StatusPage page(PlanOfPair({}), {"lidar_driver", "camera_driver"}, At(0));
  SessionFacts facts;
  facts.programs["lidar_driver"].history.has_ended_well = true;
  page.Take(facts, At(0));
  EXPECT_EQ(page.health().HealthOf("lidar_driver", At(0)), Health::kEnded);
  EXPECT_THAT(
      page.Text(At(0)),
      AllOf(HasSubstr("lidar_driver           done\n"), HasSubstr("\nsilent  camera_driver\n")));
  page.Take(Status("lidar_driver", 1, "running"), At(0));  // it was started again
  EXPECT_EQ(page.health().HealthOf("lidar_driver", At(9)), Health::kSilent);
}

TEST(StatusPage, IsSilentAfterThreeSecondsWithoutAHeartbeat) {
  StatusPage page(PlanOfPair({}), {"assessor"}, At(0));
  page.Take(Status("assessor", 1, "running"), At(10));
  EXPECT_EQ(page.health().HealthOf("assessor", At(13)), Health::kGood);
  EXPECT_EQ(page.health().HealthOf("assessor", At(13.1)), Health::kSilent);
  EXPECT_THAT(page.Text(At(15)), HasSubstr("SILENT for 5 s"));
  page.Take(Status("assessor", 2, "running"), At(16));
  EXPECT_EQ(page.health().HealthOf("assessor", At(16)), Health::kGood);
}

TEST(StatusPage, AModuleThatSaidThatItHasEndedIsNotSilent) {
  StatusPage page(PlanOfPair({}), {"lidar_driver", "camera_driver"}, At(0));
  page.Take(Status("lidar_driver", 9, "done"), At(0));
  page.Take(Status("camera_driver", 9, "stopped"), At(0));
  EXPECT_TRUE(page.IsAllGood(At(100)));
  EXPECT_THAT(page.Text(At(100)), HasSubstr("\nsilent  nobody\n"));
}

TEST(StatusPage, AFailedModuleIsNotGood) {
  StatusPage page(PlanOfPair({}), {"assessor"}, At(0));
  page.Take(Status("assessor", 3, "failed: disk full"), At(0));
  EXPECT_EQ(page.health().HealthOf("assessor", At(0)), Health::kFailed);
  EXPECT_FALSE(page.IsAllGood(At(0)));
  EXPECT_THAT(page.Text(At(0)), HasSubstr("failed: disk full"));
}

TEST(StatusPage, TellsWhoLostHowManyOfWhat) {
  StatusPage page(PlanOfPair({}), {"lidar_board_detector"}, At(0));
  module_status_t status = Status("lidar_board_detector", 1, "running");
  AddChannel(Channel("LIDAR_POINTS", 95, 5), &status);
  page.Take(status, At(0));
  EXPECT_THAT(page.Details(At(0)),
              AllOf(ContainsRegex("LIDAR_POINTS +10.0 Hz +95 received  5 LOST"),
                    HasSubstr("\nlost    lidar_board_detector: 5 of 100 LIDAR_POINTS\n")));
}

TEST(StatusPage, RateOfSendingIsThatBetweenTwoHeartbeats) {
  StatusPage page(PlanOfPair({}), {"lidar_driver"}, At(0));
  module_status_t status = Status("lidar_driver", 1, "running");
  status.num_published = 100;
  page.Take(status, At(0));
  status.seq = 2;
  status.num_published = 125;
  page.Take(status, At(2));
  EXPECT_THAT(page.Text(At(2)), HasSubstr("running  sends 12.5 Hz\n"));
}

TEST(StatusPage, ANumberingThatBeginsAnewIsARestart) {
  StatusPage page(PlanOfPair({}), {"assessor"}, At(0));
  for (const std::int64_t seq : {7, 8, 1, 2, 1}) {
    page.Take(Status("assessor", seq, "running"), At(0));
  }
  EXPECT_THAT(page.Text(At(0)), HasSubstr("assessor               running  restarted 2 times"));
}

TEST(StatusPage, ShowsTheMostFrequentResultsAndMissesFirst) {
  StatusPage page(PlanOfPair({}), {"assessor"}, At(0));
  module_status_t status = Status("assessor", 1, "running");
  AddCounter("a", 1, &status);
  AddCounter("b", 30, &status);
  AddCounter("c", 2, &status);
  AddCounter("d", 4, &status);
  AddCounter("e", 5, &status);
  page.Take(status, At(0));
  EXPECT_THAT(page.Details(At(0)), HasSubstr("    counts 30 b, 5 e, 4 d, 2 c, ...\n"));
}

TEST(StatusPage, KeepsTheLastFiveEvents) {
  StatusPage page(PlanOfPair({}), {}, At(0));
  for (int i = 1; i <= 6; ++i) {
    event_t event{};
    event.kind = i == 6 ? "rejected" : "accepted";
    event.sample_id = i == 6 ? 0 : i;
    event.reason = i == 6 ? "board is moving" : "";
    page.Take(event);
  }
  EXPECT_THAT(page.Details(At(0)),
              AllOf(HasSubstr("    accepted sample 2\n"),
                    HasSubstr("    rejected: board is moving\n"),
                    Not(HasSubstr("sample 1\n"))));
}

TEST(StatusPage, ShowsThePairsOfARigAndWhatHelpsThemNext) {
  StatusPage page(PlanOfPair({}), {}, At(0));
  rig_extrinsics_t rig{};
  rig.verdict_headline = "Good.";
  rig.advice = "Show the board to front_left.";
  rig.weakest_pair = "front_left";
  rig_pair_t pair{};
  pair.has_session = 1;
  pair.name = "front_left";
  pair.num_samples = 23;
  pair.sigma_rad = 1e-3;
  pair.sigma_m = 2e-3;
  pair.verdict_grade = "good";
  pair.verdict_headline = "Good.";
  rig.pairs.push_back(pair);
  pair.name = "rear_left";
  pair.num_samples = 0;
  pair.sigma_rad = pair.sigma_m = std::numeric_limits<double>::quiet_NaN();
  pair.problem = "the two never saw the board rest at one time";
  rig.pairs.push_back(pair);
  page.Take(rig);
  const std::string text = page.Text(At(1));
  EXPECT_THAT(text, HasSubstr("front_left      23   0.057 deg     2.0 mm  good: Good. (next)\n"));
  EXPECT_THAT(text, HasSubstr("  the two never saw the board rest at one time\n"));
  EXPECT_THAT(text, HasSubstr("rig     Good.\nnext    Show the board to front_left.\n"));
  rig.problem = "no pair joins these parts of the rig: front | left";
  page.Take(rig);
  EXPECT_THAT(page.Text(At(1)), HasSubstr("rig     no tree yet: no pair joins these parts"));
}

// Of all modules, with more faults and events than have room.
TEST(StatusPage, FitsATerminalOf24Rows) {
  StatusPage page(PlanOfPair({}), AllModuleNames(), At(0));
  for (const std::string& module : AllModuleNames()) {
    module_status_t status = Status(module, 9, "running");
    AddChannel(Channel("LIDAR_POINTS", 95, 5), &status);
    page.Take(status, At(0));
    page.Take(event_t{});
  }
  const std::string text = page.Text(At(9));
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 24) << text;
  EXPECT_THAT(text, HasSubstr(" more\n"));
}

TEST(StatusPage, ListsModulesThatNobodyAskedFor) {
  StatusPage page(PlanOfPair({}), {"assessor"}, At(0));
  page.Take(Status("assessor", 1, "running"), At(0));
  page.Take(Status("stranger", 1, "running"), At(0));
  EXPECT_THAT(page.Text(At(100)), AllOf(HasSubstr("stranger "), HasSubstr("\nsilent  assessor\n")));
}

}  // namespace
}  // namespace voqcal
