// What every process has in common, and what a killed one loses: nothing that it had accepted.

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/atomic_file.hpp"
#include "messaging/bus.hpp"
#include "rig/rig.hpp"
#include "rig_status/status_page.hpp"
#include "sample_collector/sample_collector_node.hpp"
#include "support/sightings.hpp"
#include "support/synthetic_samples.hpp"
#include "support/temporary_folder.hpp"
#include "system/system_test.hpp"
#include "voqcal/module_status_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

const std::vector<std::string> kModules = AllModuleNames();
const std::vector<std::string> kTools = {"calibrate",
                                         "calibrate_lens",
                                         "check_recording",
                                         "check_rig",
                                         "command",
                                         "compare",
                                         "evaluate",
                                         "export_extrinsic",
                                         "import_acfr",
                                         "print_camera",
                                         "publish_extrinsic",
                                         "report"};

// A test that waits for ever is ended by ctest.
constexpr std::chrono::milliseconds kPatience(100);

TEST(Programs, ExplainThemselves) {
  for (const std::string& program : test::NamesIn(std::getenv("VOQCAL_BIN"))) {
    const test::Outcome help = test::Run({test::Program(program), "--help"});
    EXPECT_EQ(help.status, 0) << program << help.err;
    EXPECT_THAT(help.out, HasSubstr("--")) << program;
  }
}

TEST(Programs, AnswerBadFlagsWithStatus2AndOneLine) {
  std::vector<std::string> programs = kModules;
  programs.insert(programs.end(), kTools.begin(), kTools.end());
  for (const std::string& program : programs) {
    for (const std::vector<std::string>& flags : {std::vector<std::string>{}, {"--no-such-flag"}}) {
      std::vector<std::string> args = {test::Program(program)};
      args.insert(args.end(), flags.begin(), flags.end());
      const test::Outcome outcome = test::Run(args);
      EXPECT_EQ(outcome.status, 2) << program;
      EXPECT_THAT(outcome.err, ::testing::MatchesRegex(program + ": [^\n]*\n"));
    }
  }
}

class EveryModule : public ::testing::TestWithParam<int> {
 protected:
  std::string Output(const std::string& module) const { return folder_.path() / (module + ".txt"); }

  test::TemporaryFolder folder_;
  std::string rig_path_ = folder_.Write("rig.yaml", test::ShortRigText());
  Rig rig_ = LoadRig(rig_path_);
};

TEST_P(EveryModule, TellsItsStatusAndEndsOnASignal) {
  std::map<std::string, std::vector<module_status_t>> statuses;
  Bus bus(rig_.lcm_url);
  bus.Subscribe<module_status_t>(
      rig_.channels.module_status, Queue::kEvery, [&statuses](const module_status_t& status) {
        statuses[status.module].push_back(status);
      });
  std::map<std::string, std::unique_ptr<test::Process>> processes;
  for (const std::string& module : kModules) {
    const std::string launch = std::string(VOQCAL_SOURCE_DIR) + "/modules/" + module + "/launch";
    processes[module] = std::make_unique<test::Process>(
        std::vector<std::string>{launch, rig_path_, "--session", folder_.path() / "session"},
        Output(module));
  }
  for (const std::string& module : kModules) {
    while (statuses[module].size() < 2) bus.HandleOnce(kPatience);
    EXPECT_EQ(statuses[module][1].seq, statuses[module][0].seq + 1) << module;
  }
  for (const auto& [module, process] : processes) process->Signal(GetParam());
  for (const auto& [module, process] : processes) {
    EXPECT_EQ(process->Wait(), 0) << module << ": " << ReadWholeFile(Output(module));
    // Its last line: the totals.
    EXPECT_THAT(ReadWholeFile(Output(module)), ContainsRegex(module + ": [^\n]*info[^\n]*\n$"));
  }
  while (bus.HandleOnce(kPatience)) {
  }
  for (const std::string& module : kModules) {
    EXPECT_EQ(statuses[module].back().state, "stopped") << module;
  }
}

INSTANTIATE_TEST_SUITE_P(Signals,
                         EveryModule,
                         ::testing::Values(SIGTERM, SIGINT),
                         [](const auto& signal) {
                           return signal.param == SIGTERM ? "Term" : "Int";
                         });

TEST(Record, SaysAtItsEndWhatTheRecordingHolds) {
  const test::TemporaryFolder folder;
  const std::string rig_path = folder.Write("rig.yaml", test::ShortRigText());
  const auto log = folder.path() / "raw.lcm";
  test::Process record({test::Tool("record"), rig_path, log}, folder.path() / "record.txt");
  Bus bus(LoadRig(rig_path).lcm_url);
  do {  // lcm-logger listens, and has written
    bus.Publish("MODULE_STATUS", module_status_t{});
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  } while (!std::filesystem::exists(log) || std::filesystem::file_size(log) == 0);
  record.Signal(SIGTERM);
  EXPECT_EQ(record.Wait(), 0);
  EXPECT_THAT(ReadWholeFile(folder.path() / "record.txt"),
              ContainsRegex("MODULE_STATUS +[0-9]+(.|\n)*unknown    no images; no sweeps"));
}

/// Shows stops to a sample collector on the network and sees its samples.
class CollectorSession {
 public:
  CollectorSession(const Rig& rig, const std::string& rig_path, const std::string& session)
      : rig_(rig),
        args_{test::Program("sample_collector"), "--rig", rig_path, "--session", session},
        output_(session + ".txt"),
        bus_(rig.lcm_url) {
    bus_.Subscribe<samples_t>(rig.channels.calib_samples,
                              Queue::kEvery,
                              [this](const samples_t& m) { num_samples_ = m.num_samples; });
  }

  void Start() { process_ = std::make_unique<test::Process>(args_, output_); }

  void Kill() {
    process_->Signal(SIGKILL);
    EXPECT_EQ(process_->Wait(), 128 + SIGKILL);
    while (bus_.HandleOnce(kPatience)) {  // what it said before
    }
    num_samples_ = -1;
  }

  void Stop() {
    process_->Signal(SIGTERM);
    EXPECT_EQ(process_->Wait(), 0);
  }

  void WaitForSamples(int num_samples) {
    while (num_samples_ != num_samples) bus_.HandleOnce(kPatience);
  }

  void ShowStop(const std::vector<BoardSample>& samples, int stop) {
    for (const test::SightingMessages& frame : test::StillFrames(samples, stop)) {
      bus_.Publish(rig_.channels.lidar_board, frame.lidar);
      bus_.Publish(rig_.channels.camera_board, frame.camera);
    }
  }

 private:
  Rig rig_;
  std::vector<std::string> args_;
  std::string output_;
  Bus bus_;
  std::unique_ptr<test::Process> process_;
  int num_samples_ = -1;
};

TEST(SampleCollector, KilledAndStartedAgainEndsWithTheSameSamples) {
  constexpr int kNumStops = 6;
  const test::TemporaryFolder folder;
  const std::string rig_path = folder.Write("rig.yaml", test::ShortRigText());
  const Rig rig = LoadRig(rig_path);
  const std::vector<BoardSample> samples = test::SynthesizeSamples({});

  CollectorSession session(rig, rig_path, folder.path() / "killed");
  session.Start();
  session.WaitForSamples(0);
  for (int stop = 0; stop < kNumStops; ++stop) {
    session.ShowStop(samples, stop);
    session.WaitForSamples(stop + 1);
    if (stop % 2 == 0) continue;
    session.Kill();
    session.Start();
    session.WaitForSamples(stop + 1);  // it goes on with what it had
  }
  session.Stop();

  Bus bus("memq://");
  SampleCollectorNode undisturbed(rig, &bus, folder.path() / "undisturbed");
  for (int stop = 0; stop < kNumStops; ++stop) {
    for (const test::SightingMessages& frame : test::StillFrames(samples, stop)) {
      bus.Publish(rig.channels.lidar_board, frame.lidar);
      bus.Publish(rig.channels.camera_board, frame.camera);
    }
  }
  while (bus.HandleOnce(std::chrono::milliseconds(0))) {
  }
  EXPECT_EQ(undisturbed.samples().size(), static_cast<std::size_t>(kNumStops));
  EXPECT_EQ(ReadWholeFile(folder.path() / "killed" / kSamplesLogName),
            ReadWholeFile(folder.path() / "undisturbed" / kSamplesLogName));
}

}  // namespace
}  // namespace voqcal
