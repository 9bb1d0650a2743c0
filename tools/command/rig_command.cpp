#include "command/rig_command.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "command/outcome.hpp"
#include "common/run_program.hpp"
#include "common/tool_main.hpp"
#include "core/sensor_network/sensor_pair.hpp"
#include "messaging/made_from.hpp"
#include "messaging/session_scenes.hpp"
#include "messaging/wall_clock.hpp"
#include "result/result_file.hpp"
#include "result/rig_extrinsics.hpp"
#include "rig_status/table_of_pairs.hpp"
#include "voqcal/command_t.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/rig_extrinsics_t.hpp"
#include "voqcal/samples_t.hpp"

namespace voqcal {
namespace {

using Clock = std::chrono::steady_clock;

// As of a pair's collector: it republishes each second, and a command may get lost.
constexpr std::chrono::seconds kPatience{3};
constexpr std::chrono::seconds kSayAgain{1};

/// What is heard of a rig.
class Hearing {
 public:
  Hearing(const std::vector<Rig>& pairs, Bus* bus) : bus_(*bus), samples_(pairs.size()) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      names_.push_back(PairName(pairs[i].lidar_name, pairs[i].camera_name));
      bus_.Keep(pairs[i].channels.calib_samples, &samples_[i]);
      bus_.Subscribe<event_t>(pairs[i].channels.calib_event,
                              Queue::kEvery,
                              [this, i](const event_t& m) { events_.emplace_back(i, m); });
    }
    bus_.Keep(pairs.front().channels.rig_extrinsics, &rig_);
    command_channel_ = pairs.front().channels.calib_command;
  }

  /// @return the command's utime.
  std::int64_t Send(const std::string& command) {
    command_t message{};
    message.utime = WallClockUs();
    message.command = command;
    bus_.Publish(command_channel_, message);
    return message.utime;
  }

  void Hear() { bus_.HandleOnce(std::chrono::milliseconds(100)); }

  /// Pairs that do not satisfy it, by name; those of which nothing is heard yet among them.
  template <typename Condition>
  std::string Without(const Condition& condition) const {
    return WithoutAmongAll(
        [&](std::size_t i) { return samples_[i] && condition(i, *samples_[i]); });
  }
  /// The same, whether anything is heard of them or not.
  template <typename Condition>
  std::string WithoutAmongAll(const Condition& condition) const {
    std::string names;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (!condition(i)) names += (names.empty() ? "" : ", ") + names_[i];
    }
    return names;
  }

  bool IsMadeOf(std::size_t pair, const samples_t& samples) const {
    return rig_ && rig_->pairs.size() > pair &&
           rig_->pairs[pair].samples_revision == samples.revision &&
           rig_->pairs[pair].samples_sha256 == samples.log_sha256;
  }

  const std::optional<rig_extrinsics_t>& rig() const { return rig_; }
  const std::string& name(std::size_t pair) const { return names_[pair]; }
  /// By pair.
  std::vector<std::pair<std::size_t, event_t>> TakeEvents() { return std::exchange(events_, {}); }

 private:
  Bus& bus_;
  std::string command_channel_;
  std::vector<std::string> names_;
  std::vector<std::optional<samples_t>> samples_;
  std::vector<std::pair<std::size_t, event_t>> events_;
  std::optional<rig_extrinsics_t> rig_;
};

[[noreturn]] void TellSilent(const std::string& pairs) {
  throw std::runtime_error("no sample collector answered for " + pairs + ": is the rig running?");
}

/// Until every collector has finished; sent again each second.
void Finish(Clock::time_point end, Hearing* hearing) {
  Clock::time_point next_send = Clock::now();
  const auto is_finished = [](std::size_t, const samples_t& samples) {
    return samples.is_finished != 0;
  };
  const auto is_heard = [](std::size_t, const samples_t&) { return true; };
  while (!hearing->Without(is_finished).empty()) {
    if (Clock::now() > end) {
      const std::string silent = hearing->Without(is_heard);
      if (!silent.empty()) TellSilent(silent);
      throw std::runtime_error("the detectors are still at work on earlier frames of " +
                               hearing->Without(is_finished));
    }
    if (Clock::now() >= next_send) {
      hearing->Send("finish");
      next_send = Clock::now() + kSayAgain;
    }
    hearing->Hear();
  }
}

/// Until the tree is made of all that the collectors have: a pair after the other.
void WaitForTree(Clock::duration wait, Hearing* hearing) {
  const auto is_done = [hearing](std::size_t pair, const samples_t& samples) {
    return hearing->IsMadeOf(pair, samples);
  };
  Clock::time_point end = Clock::now() + wait;
  std::int64_t revision = -1;
  while (!hearing->Without(is_done).empty()) {
    if (hearing->rig() && hearing->rig()->revision != revision) {
      revision = hearing->rig()->revision;
      end = Clock::now() + wait;
    }
    if (Clock::now() > end) {
      throw std::runtime_error(hearing->rig() ? "rig_calibrator is still at work on " +
                                                    hearing->Without(is_done)
                                              : "rig_calibrator did not answer: is it running?");
    }
    hearing->Hear();
  }
}

/// A page of each pair: its result, or what was seen instead.
void WriteReports(const RigCommand& command, const std::vector<Rig>& pairs) {
  for (const Rig& pair : pairs) {
    const std::filesystem::path folder =
        command.session / PairName(pair.lidar_name, pair.camera_name);
    if (!std::filesystem::exists(folder / kSamplesLogName)) continue;
    const std::string problem = RunProgram(
        {FileBesidePrograms("bin/report"), folder.string(), "--rig", pair.path.string()});
    const bool has_result = std::filesystem::exists(folder / kResultName);
    if (!problem.empty() && has_result) {
      std::fprintf(stderr, "command: no report: %s\n", problem.c_str());
    }
  }
}

void FinishAndWait(const RigCommand& command, const std::vector<Rig>& pairs, Bus* bus) {
  Hearing hearing(pairs, bus);
  const auto wait = std::chrono::duration_cast<Clock::duration>(command.wait);
  Finish(Clock::now() + wait, &hearing);
  WaitForTree(wait, &hearing);
  const rig_extrinsics_t rig = *hearing.rig();
  std::fputs(TableOfPairs(rig).c_str(), stdout);
  if (!command.session.empty() && rig.problem.empty()) {
    std::printf("result  %s\n", (command.session / kRigResultName).c_str());
  }
  std::fflush(stdout);
  if (!command.session.empty()) WriteReports(command, pairs);
  if (!rig.problem.empty()) {
    throw std::runtime_error("no calibration of the rig: " + rig.problem);
  }
  if (rig.verdict_grade == "bad") throw DemandNotMet(rig.verdict_headline);
}

/// Says what each collector made of it: a line for each that answers.
/// @return who did not answer, by name.
std::string SendAndTell(const std::string& command, Hearing* hearing) {
  std::int64_t utime = hearing->Send(command);
  Clock::time_point next_send = Clock::now() + kSayAgain;
  std::set<std::size_t> answered;
  const auto has_answered = [&answered](std::size_t pair) { return answered.count(pair) != 0; };
  for (const Clock::time_point end = Clock::now() + kPatience;
       Clock::now() < end && !hearing->WithoutAmongAll(has_answered).empty();) {
    if (command == "finish" && Clock::now() >= next_send) {
      utime = hearing->Send(command);
      next_send += kSayAgain;
    }
    hearing->Hear();
    for (const auto& [pair, event] : hearing->TakeEvents()) {
      const auto outcome = OutcomeOf(command, utime, event);
      if (!outcome || !answered.insert(pair).second) continue;
      std::printf("%s: %s\n", hearing->name(pair).c_str(), outcome->c_str());
    }
  }
  std::fflush(stdout);
  return hearing->WithoutAmongAll(has_answered);
}

/// @throws std::runtime_error if a collector is not there, or did not do what it can always do.
void SendAndJudge(const std::string& command, const std::vector<Rig>& pairs, Bus* bus) {
  Hearing hearing(pairs, bus);
  const std::string unanswered = SendAndTell(command, &hearing);
  if (unanswered.empty()) return;
  const std::string silent = hearing.Without([](std::size_t, const samples_t&) { return true; });
  if (!silent.empty()) TellSilent(silent);
  if (command == "finish") {
    std::printf(
        "sent; the detectors are still at work on earlier frames of %s (--wait waits for them)\n",
        unanswered.c_str());
    return;
  }
  if (command == "reset") {
    throw std::runtime_error("sent, but nothing is known to have come of it: " + unanswered);
  }
  if (hearing.WithoutAmongAll([](std::size_t) { return false; }) != unanswered) return;
  throw std::runtime_error(
      "no sample yet: the next frames that show the board to both sensors of a pair will be one");
}

}  // namespace

void CommandRig(const RigCommand& command, const std::vector<Rig>& pairs, Bus* bus) {
  if (command.command == "discard") {
    throw std::runtime_error("discard takes away a sample of one pair: name it, as in --rig " +
                             pairs.front().path.string());
  }
  if (command.command == "finish" && command.wait.count() > 0) {
    FinishAndWait(command, pairs, bus);
  } else {
    SendAndJudge(command.command, pairs, bus);
  }
}

}  // namespace voqcal
