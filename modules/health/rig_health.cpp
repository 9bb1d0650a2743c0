#include "health/rig_health.hpp"

#include <algorithm>
#include <utility>

#include "core/format.hpp"
#include "core/starts_with.hpp"

namespace voqcal {
namespace {

// Readers count frames once a second: a stream is silent from the second report of none on.
constexpr double kStreamSilenceS = 1.5;
constexpr double kUsualGaps = 3.0;
// Heartbeats of a sensor's driver by which its first frame should have come.
constexpr std::int64_t kStartBeats = 5;
// Two heartbeats of what ran before; what was only just started may have much to load.
constexpr double kHeardWithinS = 2.0;
constexpr std::time_t kLoadedWithinS = 20;
constexpr double kLossIsNewsS = 10.0;
// Every heartbeat is recorded.
constexpr double kRecordingSilenceS = 2.0;
// One raw image of 4 MB at 10 Hz fills it within seconds; no sample is kept once it is full.
constexpr std::int64_t kMinFreeBytes = 200 << 20;
// Heartbeats alone are one a second.
constexpr double kSendsHz = 2.5;

/// "for 4 s".
std::string For(double seconds) { return Format("for %.0f s", seconds); }

std::string EndText(const std::string& program, const ProgramFacts& facts) {
  const std::string words = facts.last_words.empty() ? "" : "; its last words: " + facts.last_words;
  return program + " ended (" + facts.history.how_ended + ")" + words;
}

}  // namespace

const char* ToString(ModuleHealth health) {
  switch (health) {
    case ModuleHealth::kGood:
      return "good";
    case ModuleHealth::kEnded:
      return "ended";
    case ModuleHealth::kSilent:
      return "silent";
    case ModuleHealth::kFailed:
      return "failed";
  }
  return "";
}

const char* ToString(Flow flow) {
  switch (flow) {
    case Flow::kNothingYet:
      return "nothing yet";
    case Flow::kFlows:
      return "flows";
    case Flow::kSilent:
      return "silent";
    case Flow::kEnded:
      return "ended";
  }
  return "";
}

RigHealth::RigHealth(const SessionPlan& plan, std::vector<std::string> modules, Time begin)
    : heartbeats_(plan.streams),
      all_modules_(plan.modules),
      modules_(std::move(modules)),
      begin_(begin) {}

void RigHealth::Take(const SessionFacts& facts, Time now) {
  const bool has_grown = facts.num_recorded_bytes != facts_.num_recorded_bytes;
  if (has_grown || last_recorded_ == Time{}) last_recorded_ = now;
  facts_ = facts;
}

void RigHealth::Expect(std::vector<std::string> modules) {
  modules_ = std::move(modules);
  are_streams_expected_ = true;
}

std::vector<Fault> RigHealth::Faults(Time now) const {
  std::vector<Fault> faults;
  AddDiskFault(&faults);
  AddRivals(now, &faults);
  AddStreamFaults(now, &faults);
  AddTroubles(now, &faults);
  AddModuleFaults(now, &faults);
  AddRecorderFault(now, &faults);
  AddSupervisorFault(&faults);
  AddRestarts(&faults);
  AddLosses(now, &faults);
  std::stable_partition(
      faults.begin(), faults.end(), [](const Fault& fault) { return fault.is_grave; });
  return faults;
}

ModuleHealth RigHealth::HealthOf(const std::string& module, Time now) const {
  const HeardModule* heard = heartbeats_.Find(module);
  if (heard == nullptr) {
    return HasEndedWell(module) ? ModuleHealth::kEnded : ModuleHealth::kSilent;
  }
  if (StartsWith(heard->status.state, "failed")) return ModuleHealth::kFailed;
  if (heard->HasEnded()) return IsDriver(module) ? ModuleHealth::kEnded : ModuleHealth::kSilent;
  return heard->IsSilent(now) ? ModuleHealth::kSilent : ModuleHealth::kGood;
}

Flow RigHealth::FlowOf(const std::string& channel, Time now) const {
  for (const Stream& stream : heartbeats_.streams()) {
    if (stream.channel == channel) return FlowOf(stream, now);
  }
  return Flow::kNothingYet;
}

Flow RigHealth::FlowOf(const Stream& stream, Time now) const {
  const double since_s = SecondsBetween(stream.last_news, now);
  if (stream.has_come && since_s <= std::max(kStreamSilenceS, kUsualGaps * stream.usual_gap_s)) {
    return Flow::kFlows;
  }
  if (HasEndedWell(stream.sender)) return Flow::kEnded;
  return stream.has_come ? Flow::kSilent : Flow::kNothingYet;
}

bool RigHealth::HasEndedWell(const std::string& module) const {
  if (!IsDriver(module)) return false;
  const HeardModule* heard = heartbeats_.Find(module);
  if (heard != nullptr) return heard->HasEnded();
  const ProgramFacts* program = ProgramOf(module);
  return program != nullptr && (program->history.has_ended_well || program->history.was_stopped);
}

std::string RigHealth::HowEnded(const std::string& module) const {
  const HeardModule* heard = heartbeats_.Find(module);
  if (heard != nullptr) return heard->status.state;
  const ProgramFacts* program = ProgramOf(module);
  return program != nullptr && program->history.was_stopped ? "stopped" : "done";
}

const ProgramFacts* RigHealth::ProgramOf(const std::string& name) const {
  const auto found = facts_.programs.find(name);
  return found == facts_.programs.end() ? nullptr : &found->second;
}

bool RigHealth::IsElsewhere(const std::string& module) const {
  return are_streams_expected_ && !facts_.programs.empty() && ProgramOf(module) == nullptr &&
         heartbeats_.Find(module) == nullptr;
}

bool RigHealth::IsExpected(const std::string& module) const {
  return ProgramOf(module) != nullptr || heartbeats_.Find(module) != nullptr ||
         std::find(modules_.begin(), modules_.end(), module) != modules_.end();
}

const Stream* RigHealth::StreamOfSender(const std::string& module) const {
  for (const Stream& stream : heartbeats_.streams()) {
    if (stream.sender == module) return &stream;
  }
  return nullptr;
}

void RigHealth::AddDiskFault(std::vector<Fault>* faults) const {
  if (!facts_.num_free_bytes || *facts_.num_free_bytes >= kMinFreeBytes) return;
  const auto num_mb = static_cast<long long>(*facts_.num_free_bytes >> 20);
  faults->push_back(
      {"disk",
       num_mb == 0 ? "The disk is full" : Format("The disk is nearly full, %lld MB left", num_mb),
       "samples and recording lie in the session's folder",
       "Make room there, or begin a session on another disk (tools/up --session)."});
}

void RigHealth::AddSupervisorFault(std::vector<Fault>* faults) const {
  if (facts_.supervisor == SupervisorState::kRuns) return;
  const bool is_dead = facts_.supervisor == SupervisorState::kDead;
  faults->push_back({"supervisor",
                     "What ends is not started again",
                     std::string("the session's supervisor was ") + (is_dead ? "killed" : "halted"),
                     is_dead ? "Run tools/down, then tools/up with the same --session: it goes on."
                             : "kill -CONT and the number in supervisord.pid lets it go on."});
}

void RigHealth::AddRivals(Time now, std::vector<Fault>* faults) const {
  for (const std::string& rival : heartbeats_.Rivals(now)) {
    faults->push_back({"network",
                       "Two sessions run on one network",
                       rival,
                       "Stop one of them (tools/down), or give it another port in lcm.url."});
  }
}

// A detector that has nothing to read is silent for that.
void RigHealth::AddStreamFaults(Time now, std::vector<Fault>* faults) const {
  for (const Stream& stream : heartbeats_.streams()) {
    const Flow flow = FlowOf(stream, now);
    if (flow == Flow::kFlows || flow == Flow::kEnded) continue;
    const bool is_sensor = stream.input.empty();
    if (!is_sensor && FlowOf(stream.input, now) != Flow::kFlows) continue;
    const bool is_expected = IsExpected(stream.sender) || are_streams_expected_;
    const bool may_come = IsStarting(stream.sender, now) || !is_expected;
    if (flow == Flow::kNothingYet && (may_come || !stream.has_reader)) continue;
    const std::string cause = CauseAt(stream.sender, now);
    const std::string who = is_sensor ? "The " + stream.name : stream.name;
    const std::string what = who + " has sent nothing " +
                             (flow == Flow::kSilent    ? For(SecondsBetween(stream.last_news, now))
                              : stream.has_come_before ? "lately"
                                                       : "yet");
    const std::string file = stream.sender + ".txt in the session's folder says more.";
    faults->push_back({stream.name,
                       what,
                       cause.empty() ? stream.sender + " runs, and gets nothing" : cause,
                       IsElsewhere(stream.sender)
                           ? "Start it too (tools/up --only " + stream.sender + "), on its host."
                       : is_sensor ? "Check the " + stream.name +
                                         "'s power, cable and address in the rig file; " + file
                                   : file});
  }
}

bool RigHealth::IsDown(const std::string& module, Time now) const {
  const ProgramFacts* program = ProgramOf(module);
  const bool has_run = program != nullptr && !program->history.how_ended.empty();
  return (has_run && !program->history.is_running) ||
         HealthOf(module, now) == ModuleHealth::kFailed;
}

bool RigHealth::IsStarting(const std::string& module, Time now) const {
  if (IsDown(module, now)) return false;
  const ProgramFacts* program = ProgramOf(module);
  // tools/up starts the drivers once all else listens.
  const bool is_to_come = program != nullptr && !program->history.is_running;
  const HeardModule* heard = heartbeats_.Find(module);
  if (is_to_come && heard == nullptr) return !program->history.was_stopped;
  if (heard != nullptr) return heard->status.seq < kStartBeats;
  if (program != nullptr) return program->running_s < kLoadedWithinS;
  return SecondsBetween(begin_, now) < kHeardWithinS;
}

std::string RigHealth::CauseAt(const std::string& module, Time now) const {
  const ProgramFacts* program = ProgramOf(module);
  const bool has_run = program != nullptr && !program->history.how_ended.empty();
  if (has_run && !program->history.is_running) return EndText(module, *program);
  if (program != nullptr && program->history.was_stopped) return module + " was stopped";
  const HeardModule* heard = heartbeats_.Find(module);
  if (heard == nullptr) {
    if (IsElsewhere(module)) return module + " was not started here, and is not heard";
    return IsExpected(module) ? module + " was not heard" : module + " is not of this session";
  }
  const module_status_t& status = heard->status;
  switch (HealthOf(module, now)) {
    case ModuleHealth::kFailed:
      return module + " " + status.state;
    case ModuleHealth::kSilent:
      if (heard->HasEnded()) return module + " was stopped";
      return module + " has not answered " + For(SecondsBetween(heard->at, now));
    case ModuleHealth::kGood:
    case ModuleHealth::kEnded:
      break;
  }
  if (heard->published_hz > kSendsHz) return module + " sends, but nothing arrives";
  return status.state == "running" ? "" : module + " is " + status.state;
}

void RigHealth::AddTroubles(Time now, std::vector<Fault>* faults) const {
  const std::string mark = "trouble: ";
  for (const auto& [module, heard] : heartbeats_.heard()) {
    if (!StartsWith(heard.status.state, mark) || HealthOf(module, now) != ModuleHealth::kGood)
      continue;
    const std::string text = heard.status.state.substr(mark.size());
    const std::size_t end = text.find("; ");
    faults->push_back({module,
                       text.substr(0, end),
                       "",
                       end == std::string::npos ? "" : text.substr(end + 2) + "."});
  }
}

void RigHealth::AddModuleFaults(Time now, std::vector<Fault>* faults) const {
  for (const std::string& module : all_modules_) {
    const bool is_told = std::any_of(faults->begin(), faults->end(), [&](const Fault& fault) {
      const Stream* stream = StreamOfSender(module);
      return fault.of == module || (stream != nullptr && fault.of == stream->name);
    });
    if (is_told || !IsExpected(module)) continue;
    const ModuleHealth health = HealthOf(module, now);
    if (health == ModuleHealth::kGood || health == ModuleHealth::kEnded) continue;
    if (heartbeats_.Find(module) == nullptr && IsStarting(module, now)) continue;
    faults->push_back({module,
                       module + (health == ModuleHealth::kFailed ? " has failed" : " is silent"),
                       CauseAt(module, now),
                       module + ".txt in the session's folder says more."});
  }
}

void RigHealth::AddRecorderFault(Time now, std::vector<Fault>* faults) const {
  const ProgramFacts* recorder = ProgramOf(kRecorder);
  if (recorder == nullptr) return;
  const ProgramHistory& history = recorder->history;
  const std::string remedy =
      "What is not recorded cannot be calibrated again; lcm-logger.txt says more.";
  if (!history.is_running &&
      (history.has_given_up || !history.how_ended.empty() || history.was_stopped)) {
    const std::string cause =
        history.was_stopped ? "lcm-logger was stopped" : EndText(kRecorder, *recorder);
    faults->push_back({"recorder", "Nothing is recorded", cause, remedy});
  } else if (SecondsBetween(last_recorded_, now) > kRecordingSilenceS) {
    const std::string what =
        "The recording has not grown " + For(SecondsBetween(last_recorded_, now));
    faults->push_back({"recorder", what, "lcm-logger runs, and writes nothing", remedy});
  }
}

void RigHealth::AddRestarts(std::vector<Fault>* faults) const {
  for (const auto& [name, program] : facts_.programs) {
    if (program.num_ends_lately == 0 || !program.history.is_running) continue;
    const std::string times =
        program.num_ends_lately == 1 ? "" : Format(" %d times", program.num_ends_lately);
    const bool is_recorder = name == kRecorder;
    faults->push_back({is_recorder ? "recorder" : name,
                       name + " was started again" + times,
                       EndText(name, program),
                       is_recorder
                           ? "What came between is not recorded; it goes on in another file."
                           : "What it missed is missing in the live result.",
                       program.num_ends_lately > 2});
  }
}

void RigHealth::AddLosses(Time now, std::vector<Fault>* faults) const {
  const std::string losses = heartbeats_.Losses();
  if (losses.empty()) return;
  const bool is_now =
      heartbeats_.last_loss() && SecondsBetween(*heartbeats_.last_loss(), now) < kLossIsNewsS;
  faults->push_back({"network",
                     is_now ? "Messages are being lost" : "Messages were lost",
                     losses,
                     "The computer or its network is too slow for the sensors' rates, or "
                     "net.core.rmem_max is too small.",
                     false});
}

}  // namespace voqcal
