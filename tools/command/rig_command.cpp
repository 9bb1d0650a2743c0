#include "command/rig_command.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <utility>

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
                              [this, i](const event_t& m) { events_.emplace_back(names_[i], m); });
    }
    bus_.Keep(pairs.front().channels.rig_extrinsics, &rig_);
    command_channel_ = pairs.front().channels.calib_command;
  }

  void Send(const std::string& command) {
    command_t message{};
    message.utime = WallClockUs();
    message.command = command;
    bus_.Publish(command_channel_, message);
  }

  void Hear() { bus_.HandleOnce(std::chrono::milliseconds(100)); }

  /// Pairs that do not satisfy it, by name; those of which nothing is heard yet among them.
  template <typename Condition>
  std::string Without(const Condition& condition) const {
    std::string names;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (samples_[i] && condition(i, *samples_[i])) continue;
      names += (names.empty() ? "" : ", ") + names_[i];
    }
    return names;
  }

  bool IsMadeOf(std::size_t pair, const samples_t& samples) const {
    return rig_ && rig_->pairs.size() > pair &&
           rig_->pairs[pair].samples_revision == samples.revision &&
           rig_->pairs[pair].samples_sha256 == samples.log_sha256;
  }

  const std::optional<rig_extrinsics_t>& rig() const { return rig_; }
  std::vector<std::pair<std::string, event_t>> TakeEvents() { return std::exchange(events_, {}); }

 private:
  Bus& bus_;
  std::string command_channel_;
  std::vector<std::string> names_;
  std::vector<std::optional<samples_t>> samples_;
  std::vector<std::pair<std::string, event_t>> events_;
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

/// Says what each collector made of it.
void SendAndTell(const RigCommand& command, const std::vector<Rig>& pairs, Bus* bus) {
  const std::string wanted = command.command == "capture" ? "accepted"
                             : command.command == "reset" ? "reset"
                                                          : "finished";
  Hearing hearing(pairs, bus);
  hearing.Send(command.command);
  std::size_t num_done = 0;
  for (const Clock::time_point end = Clock::now() + kPatience;
       Clock::now() < end && num_done < pairs.size();) {
    hearing.Hear();
    for (const auto& [pair, event] : hearing.TakeEvents()) {
      if (event.kind != wanted) continue;
      ++num_done;
      std::printf(
          "%s: %s%s\n",
          pair.c_str(),
          event.kind.c_str(),
          event.sample_id == 0 ? "" : (" sample " + std::to_string(event.sample_id)).c_str());
    }
  }
  if (num_done > 0) return;
  const std::string silent = hearing.Without([](std::size_t, const samples_t&) { return true; });
  if (!silent.empty()) TellSilent(silent);
  throw std::runtime_error(command.command == "capture"
                               ? "no sample yet: the next frames that show the board to both "
                                 "sensors of a pair will be one"
                               : "sent, but nothing is known to have come of it");
}

}  // namespace

void CommandRig(const RigCommand& command, const std::vector<Rig>& pairs, Bus* bus) {
  if (command.command == "discard") {
    throw std::runtime_error(
        "discard takes away a sample of one pair, and all pairs of a rig hear it: leave it to the "
        "calibration, which takes out what contradicts the rest");
  }
  if (command.command == "finish" && command.wait.count() > 0) {
    FinishAndWait(command, pairs, bus);
  } else {
    SendAndTell(command, pairs, bus);
  }
}

}  // namespace voqcal
