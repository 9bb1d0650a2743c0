// The tool command and a live sample collector.

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "messaging/bus.hpp"
#include "sample_collector/session_log.hpp"
#include "support/synthetic_samples.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"
#include "voqcal/command_t.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

class Command : public ::testing::Test {
 protected:
  /// Returns once the collector is heard, with 30 samples.
  void StartCollector() {
    for (const BoardSample& sample : test::SynthesizeSamples({})) {
      SessionLog(session_).Accept(sample);
    }
    collector_ = std::make_unique<test::Process>(
        std::vector<std::string>{
            test::Program("sample_collector"), "--rig", rig_, "--session", session_},
        folder_.path() / "collector.txt");
    const Rig rig = LoadRig(rig_);
    Bus bus(rig.lcm_url);
    bool is_heard = false;
    bus.Subscribe<samples_t>(
        rig.channels.calib_samples, Queue::kState, [&](const samples_t&) { is_heard = true; });
    for (int i = 0; i < 300 && !is_heard; ++i) bus.HandleOnce(std::chrono::milliseconds(100));
    ASSERT_TRUE(is_heard) << ReadWholeFile(folder_.path() / "collector.txt");
  }

  test::Outcome Give(std::vector<std::string> args) const {
    args.insert(args.begin(), test::Program("command"));
    args.insert(args.end(), {"--rig", rig_});
    return test::Run(args);
  }

  test::TemporaryFolder folder_;
  std::string rig_ = folder_.Write("rig.yaml", test::ShortRigText());
  std::string session_ = folder_.path() / "session";
  std::unique_ptr<test::Process> collector_;
};

TEST_F(Command, SaysWhatCameOfIt) {
  StartCollector();
  EXPECT_EQ(Give({"discard", "--sample", "7"}).out, "sample 7 discarded\n");
  EXPECT_EQ(Give({"discard"}).out, "sample 30 discarded\n");
  EXPECT_EQ(Give({"finish"}).out, "finished\n");
  EXPECT_EQ(Give({"reset"}).out, "all samples taken away\n");
}

TEST_F(Command, SaysWhatCouldNotBeDone) {
  StartCollector();
  const test::Outcome missing = Give({"discard", "--sample", "99"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_EQ(missing.err, "command: there is no sample 99\n");
  const test::Outcome no_frames = Give({"capture"});
  EXPECT_EQ(no_frames.status, 1);
  EXPECT_THAT(no_frames.err, HasSubstr("no sample yet: no pair of frames came"));
}

/// What `command` prints when a collector, alive, answers it with these events.
class CommandToACollectorThat : public Command {
 protected:
  std::string Answers(const std::string& command, const std::vector<event_t>& events) const {
    const Rig rig = LoadRig(rig_);
    Bus bus(rig.lcm_url);
    bus.Subscribe<command_t>(rig.channels.calib_command, Queue::kEvery, [&](const command_t&) {
      bus.Publish(rig.channels.calib_samples, samples_t{});
      for (const event_t& event : events) bus.Publish(rig.channels.calib_event, event);
    });
    const auto out = folder_.path() / "out.txt";
    test::Process process({test::Program("command"), command, "--rig", rig_}, out);
    // More than its patience of 3 s.
    for (int i = 0; i < 50 && ReadWholeFile(out).empty(); ++i) {
      bus.HandleOnce(std::chrono::milliseconds(100));
    }
    EXPECT_EQ(process.Wait(), 0);
    return ReadWholeFile(out);
  }
};

event_t Accepted(std::int64_t sample_id, const std::string& reason) {
  event_t event{};
  event.kind = "accepted";
  event.sample_id = sample_id;
  event.reason = reason;
  return event;
}

TEST_F(CommandToACollectorThat, TakesASampleByItselfFirst) {
  EXPECT_EQ(Answers("capture", {Accepted(7, ""), Accepted(8, "by command")}),
            "sample 8 taken by command\n");
}

TEST_F(CommandToACollectorThat, WaitsForSlowDetectors) {
  EXPECT_EQ(Answers("finish", {}),
            "sent; the detectors are still at work on earlier frames (--wait waits for them)\n");
}

TEST_F(Command, SaysThatNobodyAnswered) {
  const test::Outcome outcome = Give({"capture"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "command: the sample collector did not answer: is the rig running?\n");
}

}  // namespace
}  // namespace voqcal
