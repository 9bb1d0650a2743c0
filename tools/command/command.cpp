// command: tells the sample collectors of a running rig what to do.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "command/outcome.hpp"
#include "command/rig_command.hpp"
#include "common/run_program.hpp"
#include "common/tool_main.hpp"
#include "core/sensor_network/sensor_pair.hpp"
#include "messaging/bus.hpp"
#include "messaging/made_from.hpp"
#include "messaging/session_name.hpp"
#include "messaging/wall_clock.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"
#include "voqcal/assessment_t.hpp"
#include "voqcal/command_t.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

using Clock = std::chrono::steady_clock;

// A collector republishes each second, and takes up to two to see that no frame comes any more.
constexpr std::chrono::seconds kPatience{3};

// A command may get lost. To finish, said again, asks for nothing more.
constexpr std::chrono::seconds kSayFinishAgain{1};

constexpr char kNoAnswer[] = "the sample collector did not answer: is the rig running?";

/// For a result, where none is given: what run_rig takes.
constexpr double kWaitForResultS = 60;

struct CommandArgs {
  std::filesystem::path rig;
  std::filesystem::path session;
  std::optional<std::string> lcm_url;
  std::string command;
  std::int64_t sample_id = 0;
  double wait_s = 0;
};

/// @return the command's utime.
std::int64_t Send(const CommandArgs& args, const Rig& rig, Bus* bus) {
  command_t message{};
  message.utime = WallClockUs();
  message.command = args.command;
  message.sample_id = args.sample_id;
  message.pair = PairName(rig.lidar_name, rig.camera_name);
  bus->Publish(rig.channels.calib_command, message);
  return message.utime;
}

void SendAndTellOutcome(const CommandArgs& args, const Rig& rig, Bus* bus) {
  std::optional<samples_t> samples;
  std::vector<event_t> events;
  bus->Subscribe<samples_t>(
      rig.channels.calib_samples, Queue::kState, [&samples](const samples_t& m) { samples = m; });
  bus->Subscribe<event_t>(rig.channels.calib_event, Queue::kEvery, [&events](const event_t& m) {
    events.push_back(m);
  });
  const std::int64_t utime = Send(args, rig, bus);
  Clock::time_point next_send = Clock::now() + kSayFinishAgain;
  std::string last_reason;
  for (const Clock::time_point end = Clock::now() + kPatience; Clock::now() < end;) {
    if (args.command == "finish" && Clock::now() >= next_send) {
      Send(args, rig, bus);
      next_send += kSayFinishAgain;
    }
    bus->HandleOnce(std::chrono::milliseconds(100));
    for (const event_t& event : events) {
      if (const auto outcome = OutcomeOf(args.command, utime, event)) {
        std::puts(outcome->c_str());
        return;
      }
      last_reason = event.reason;
    }
    events.clear();
  }
  if (!samples) throw std::runtime_error(kNoAnswer);
  if (args.command == "finish") {
    std::puts("sent; the detectors are still at work on earlier frames (--wait waits for them)");
    return;
  }
  if (args.command != "capture")
    throw std::runtime_error("sent, but nothing is known to have come of it");
  throw std::runtime_error(
      "no sample yet: " +
      (last_reason.empty() ? std::string("no pair of frames came") : last_reason) +
      "; the next frames that show the board to both sensors will be one");
}

/// What the live modules found, as a page to look at.
void WriteReport(const CommandArgs& args) {
  const std::string result = (args.session / kResultName).string();
  std::printf("result   %s\n", result.c_str());
  std::fflush(stdout);
  const std::string problem = RunProgram(
      {FileBesidePrograms("bin/report"), args.session.string(), "--rig", args.rig.string()});
  if (!problem.empty()) std::fprintf(stderr, "command: no report: %s\n", problem.c_str());
}

/// Where there is no result, a page of what was seen instead.
void WriteWhatWasSeen(const CommandArgs& args) {
  const std::filesystem::path page = args.session / kNoResultName;
  std::filesystem::remove(page);
  RunProgram({FileBesidePrograms("bin/report"), args.session.string(), "--rig", args.rig.string()});
  if (std::filesystem::exists(page)) std::printf("what was seen: %s\n", page.c_str());
  std::fflush(stdout);
}

// Until the collector says "finished" and the assessor has judged that very set of samples. The
// command is sent again each second: it may have been lost.
void FinishAndWait(const CommandArgs& args, const Rig& rig, Bus* bus) {
  samples_t samples{};
  assessment_t assessment{};
  assessment.samples_revision = -1;
  bool is_heard = false;
  bus->Subscribe<samples_t>(rig.channels.calib_samples, Queue::kState, [&](const samples_t& m) {
    samples = m;
    is_heard = true;
  });
  bus->Subscribe<assessment_t>(rig.channels.calib_assessment,
                               Queue::kState,
                               [&assessment](const assessment_t& m) { assessment = m; });
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(args.wait_s));
  Clock::time_point next_send = Clock::now();
  while (samples.is_finished == 0 || !IsMadeFrom(samples, assessment)) {
    if (Clock::now() > end) {
      throw std::runtime_error(samples.is_finished != 0
                                   ? "the assessor did not answer: is it running?"
                               : is_heard ? "the detectors are still at work on earlier frames"
                                          : kNoAnswer);
    }
    if (samples.is_finished == 0 && Clock::now() >= next_send) {
      Send(args, rig, bus);
      next_send = Clock::now() + kSayFinishAgain;
    }
    bus->HandleOnce(std::chrono::milliseconds(100));
  }
  if (!assessment.problem.empty()) {
    if (!args.session.empty()) WriteWhatWasSeen(args);
    throw std::runtime_error("no calibration: " + assessment.problem);
  }
  std::printf("verdict  %s\n%d samples, held-out centre error %.2f mm mean\n",
              assessment.verdict_headline.c_str(),
              assessment.num_samples,
              assessment.refined_held_out.centre_mm.mean);
  if (!args.session.empty()) WriteReport(args);
  if (assessment.verdict_grade == "bad") throw DemandNotMet(assessment.verdict_headline);
}

/// What a session's folder tells: its rig, and that a result is waited for.
CommandArgs WithSession(CommandArgs args) {
  if (args.session.empty()) return args;
  if (args.rig.empty()) args.rig = args.session / "rig.yaml";
  if (args.wait_s == 0) args.wait_s = kWaitForResultS;
  return args;
}

void Command(const CommandArgs& given) {
  const CommandArgs args = WithSession(given);
  const std::vector<Rig> pairs = LoadPairs(args.rig);
  const Rig& rig = pairs.front();
  Bus bus(args.lcm_url.value_or(rig.lcm_url));
  bus.SetSession(SessionName(args.session));
  if (pairs.size() > 1) {
    const std::chrono::duration<double> wait(args.wait_s);
    return CommandRig({args.command, wait, args.session}, pairs, &bus);
  }
  if (args.command == "finish" && args.wait_s > 0) {
    FinishAndWait(args, rig, &bus);
  } else {
    SendAndTellOutcome(args, rig, &bus);
  }
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Sends one command to the sample collector of a running rig, and says what came of it; "
      "status 1 if nothing did, 3 if it is a result whose verdict is \"do not use\".",
      "command");
  voqcal::CommandArgs args;
  app.add_option("command",
                 args.command,
                 "capture: take the next pair of frames; discard: take a sample away; finish: no "
                 "more will come; reset: take all samples away")
      ->required()
      ->check(CLI::IsMember({"capture", "discard", "finish", "reset"}));
  app.add_option("--sample", args.sample_id, "Which sample to discard; without it the newest");
  app.add_option("--wait",
                 args.wait_s,
                 "After finish: wait for the result, at most this many seconds (of several "
                 "sensors: for each pair's)")
      ->check(CLI::NonNegativeNumber);
  auto* which = app.add_option_group("which", "At least one of:")->require_option(1, 2);
  which
      ->add_option(
          "--session",
          args.session,
          "The session's folder: its rig; finish waits for the result and makes report.html")
      ->check(CLI::ExistingDirectory);
  which->add_option("--rig", args.rig, "The rig file (YAML), instead of the session's");
  app.add_option("--lcm-url", args.lcm_url, "Instead of the rig file's");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Command(args); });
}
