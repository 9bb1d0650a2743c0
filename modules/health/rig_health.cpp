#include "health/rig_health.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

#include "core/format.hpp"

namespace voqcal {
namespace {

// Heartbeats come once a second: two that got lost are no alarm.
constexpr double kSilenceS = 3.0;
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

bool StartsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

double SecondsBetween(RigHealth::Time from, RigHealth::Time to) {
  return std::chrono::duration<double>(to - from).count();
}

bool SaysThatItEnded(const module_status_t& status) {
  return status.state == "done" || status.state == "stopped";
}

/// "for 4 s".
std::string For(double seconds) { return Format("for %.0f s", seconds); }

std::int64_t NumReceived(const HeardModule* heard, const std::string& channel) {
  if (heard == nullptr) return 0;
  for (const channel_status_t& each : heard->status.channels) {
    if (each.channel == channel) return each.num_received;
  }
  return 0;
}

std::string EndText(const std::string& program, const ProgramFacts& facts) {
  const std::string words = facts.last_words.empty() ? "" : "; its last words: " + facts.last_words;
  return program + " ended (" + facts.history.how_ended + ")" + words;
}

}  // namespace

std::string ToString(const Fault& fault) {
  return fault.what + (fault.cause.empty() ? "" : ": " + fault.cause) + ". " + fault.remedy;
}

std::vector<std::string> AllModuleNames() {
  std::istringstream names(VOQCAL_MODULES);  // modules/names.txt
  return {std::istream_iterator<std::string>(names), {}};
}

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

RigHealth::RigHealth(const Channels& channels, std::vector<std::string> modules, Time begin)
    : modules_(std::move(modules)),
      streams_{{channels.lidar_points, "lidar_driver", "lidar"},
               {channels.camera_image, "camera_driver", "camera"},
               {channels.lidar_board, "lidar_board_detector", "lidar_board_detector"},
               {channels.camera_board, "camera_board_detector", "camera_board_detector"}},
      begin_(begin) {}

void RigHealth::Take(const module_status_t& status, Time now) {
  const auto found = heard_.find(status.module);
  HeardModule heard{status, now};
  const HeardModule* before = found == heard_.end() ? nullptr : &found->second;
  if (before != nullptr) {
    const bool is_same = status.session == before->status.session;
    const bool is_restarted = is_same && status.seq <= before->status.seq;
    heard.num_restarts = before->num_restarts + (is_restarted ? 1 : 0);
    heard.sessions = before->sessions;
    const double elapsed_s = SecondsBetween(before->at, now);
    if (is_same && !is_restarted && elapsed_s > 0) {
      heard.published_hz =
          static_cast<double>(status.num_published - before->status.num_published) / elapsed_s;
    }
    if (!is_same || is_restarted) before = nullptr;  // its counts began anew
  }
  NoteNews(status, before, now);
  NoteLosses(status, before, now);
  heard.sessions[status.session] = now;
  if (SaysThatItEnded(status)) heard.sessions.erase(status.session);
  heard_[status.module] = std::move(heard);
}

void RigHealth::NoteNews(const module_status_t& status, const HeardModule* before, Time now) {
  for (Stream& stream : streams_) {
    for (const channel_status_t& channel : status.channels) {
      if (channel.channel != stream.channel) continue;
      const std::int64_t num_new = channel.num_received - NumReceived(before, channel.channel);
      // What the first heartbeat counts may have come long ago.
      const bool is_news = before != nullptr ? num_new > 0 : channel.rate_hz > 0;
      if (!is_news) continue;
      if (before != nullptr) {
        const double reported_s = SecondsBetween(before->at, now) / static_cast<double>(num_new);
        const double since_s = stream.has_come ? SecondsBetween(stream.last_news, now) : 0.0;
        const double gap_s = num_new > 1 ? reported_s : std::max(reported_s, since_s);
        stream.usual_gap_s = 0.5 * (stream.usual_gap_s + gap_s);
      }
      stream.has_come = true;
      stream.last_news = now;
    }
  }
}

void RigHealth::NoteLosses(const module_status_t& status, const HeardModule* before, Time now) {
  const auto sum = [](const module_status_t& of) {
    std::int64_t num_lost = 0;
    for (const channel_status_t& channel : of.channels) num_lost += channel.num_lost;
    return num_lost;
  };
  if (sum(status) > (before == nullptr ? 0 : sum(before->status))) last_loss_ = now;
}

void RigHealth::Take(const SessionFacts& facts, Time now) {
  const bool has_grown = facts.num_recorded_bytes != facts_.num_recorded_bytes;
  if (has_grown || last_recorded_ == Time{}) last_recorded_ = now;
  facts_ = facts;
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
  const auto found = heard_.find(module);
  if (found == heard_.end()) {
    return HasEndedWell(module) ? ModuleHealth::kEnded : ModuleHealth::kSilent;
  }
  const HeardModule& heard = found->second;
  if (StartsWith(heard.status.state, "failed")) return ModuleHealth::kFailed;
  if (SaysThatItEnded(heard.status)) return ModuleHealth::kEnded;
  const bool is_silent = SecondsBetween(heard.at, now) > kSilenceS;
  return is_silent ? ModuleHealth::kSilent : ModuleHealth::kGood;
}

Flow RigHealth::FlowOf(const std::string& channel, Time now) const {
  for (const Stream& stream : streams_) {
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
  const auto found = heard_.find(module);
  if (found != heard_.end()) return SaysThatItEnded(found->second.status);
  const ProgramFacts* program = ProgramOf(module);
  return program != nullptr && program->history.has_ended_well;
}

const ProgramFacts* RigHealth::ProgramOf(const std::string& name) const {
  const auto found = facts_.programs.find(name);
  return found == facts_.programs.end() ? nullptr : &found->second;
}

bool RigHealth::IsExpected(const std::string& module) const {
  return ProgramOf(module) != nullptr || heard_.count(module) != 0 ||
         std::find(modules_.begin(), modules_.end(), module) != modules_.end();
}

const RigHealth::Stream* RigHealth::StreamOfSender(const std::string& module) const {
  for (const Stream& stream : streams_) {
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
  if (!facts_.is_supervisor_dead) return;
  faults->push_back({"supervisor",
                     "What ends is not started again",
                     "the session's supervisor was killed",
                     "Run tools/down, then tools/up with the same --session: it goes on."});
}

void RigHealth::AddRivals(Time now, std::vector<Fault>* faults) const {
  for (const std::string& rival : Rivals(now)) {
    faults->push_back({"network",
                       "Two sessions run on one network",
                       rival,
                       "Stop one of them (tools/down), or give it another port in lcm.url."});
  }
}

// A detector that has nothing to read is silent for that.
void RigHealth::AddStreamFaults(Time now, std::vector<Fault>* faults) const {
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const Stream& stream = streams_[i];
    const Flow flow = FlowOf(stream, now);
    if (flow == Flow::kFlows || flow == Flow::kEnded) continue;
    const bool is_sensor = i < 2;
    if (!is_sensor && FlowOf(streams_[i - 2], now) != Flow::kFlows) continue;
    const bool may_come = IsStarting(stream.sender, now) || !IsExpected(stream.sender);
    if (flow == Flow::kNothingYet && may_come) continue;
    const std::string cause = CauseAt(stream.sender, now);
    const std::string who = is_sensor ? "The " + stream.name : stream.name;
    const std::string what =
        who + " has sent nothing " +
        (flow == Flow::kSilent ? For(SecondsBetween(stream.last_news, now)) : "yet");
    const std::string file = stream.sender + ".txt in the session's folder says more.";
    faults->push_back({stream.name,
                       what,
                       cause.empty() ? stream.sender + " runs, and gets nothing" : cause,
                       is_sensor ? "Check the " + stream.name +
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
  if (is_to_come && heard_.count(module) == 0) return !program->history.was_stopped;
  const auto found = heard_.find(module);
  if (found != heard_.end()) return found->second.status.seq < kStartBeats;
  if (program != nullptr) return program->running_s < kLoadedWithinS;
  return SecondsBetween(begin_, now) < kHeardWithinS;
}

std::string RigHealth::CauseAt(const std::string& module, Time now) const {
  const ProgramFacts* program = ProgramOf(module);
  const bool has_run = program != nullptr && !program->history.how_ended.empty();
  if (has_run && !program->history.is_running) return EndText(module, *program);
  if (program != nullptr && program->history.was_stopped) return module + " was stopped";
  const auto found = heard_.find(module);
  if (found == heard_.end()) {
    return IsExpected(module) ? module + " was not heard" : module + " is not of this session";
  }
  const module_status_t& status = found->second.status;
  switch (HealthOf(module, now)) {
    case ModuleHealth::kFailed:
      return module + " " + status.state;
    case ModuleHealth::kSilent:
      return module + " has not answered " + For(SecondsBetween(found->second.at, now));
    case ModuleHealth::kGood:
    case ModuleHealth::kEnded:
      break;
  }
  if (found->second.published_hz > kSendsHz) return module + " sends, but nothing arrives";
  return status.state == "running" ? "" : module + " is " + status.state;
}

void RigHealth::AddTroubles(Time now, std::vector<Fault>* faults) const {
  const std::string mark = "trouble: ";
  for (const auto& [module, heard] : heard_) {
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
  for (const std::string& module : AllModuleNames()) {
    const bool is_told = std::any_of(faults->begin(), faults->end(), [&](const Fault& fault) {
      const Stream* stream = StreamOfSender(module);
      return fault.of == module || (stream != nullptr && fault.of == stream->name);
    });
    if (is_told || !IsExpected(module)) continue;
    const ModuleHealth health = HealthOf(module, now);
    if (health == ModuleHealth::kGood || health == ModuleHealth::kEnded) continue;
    if (heard_.count(module) == 0 && IsStarting(module, now)) continue;
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
  const std::string losses = Losses();
  if (losses.empty()) return;
  const bool is_now = last_loss_ && SecondsBetween(*last_loss_, now) < kLossIsNewsS;
  faults->push_back({"network",
                     is_now ? "Messages are being lost" : "Messages were lost",
                     losses,
                     "The computer or its network is too slow for the sensors' rates, or "
                     "net.core.rmem_max is too small.",
                     false});
}

std::vector<std::string> RigHealth::Rivals(Time now, const std::string& own) const {
  std::vector<std::string> rivals;
  for (const auto& [module, heard] : heard_) {
    std::vector<std::string> sessions = SessionsOf(heard, now);
    sessions.erase(std::remove(sessions.begin(), sessions.end(), own), sessions.end());
    if (sessions.size() < (own.empty() ? 2U : 1U)) continue;
    std::string names;
    for (const std::string& session : sessions)
      names += (names.empty() ? "" : " and of ") + session;
    rivals.push_back(module + " of " + names + " runs on this network");
  }
  return rivals;
}

std::vector<std::string> RigHealth::SessionsOf(const HeardModule& heard, Time now) const {
  std::vector<std::string> sessions;
  for (const auto& [session, at] : heard.sessions) {
    if (SecondsBetween(at, now) <= kSilenceS) sessions.push_back(session);
  }
  return sessions;
}

std::string RigHealth::Losses() const {
  std::string text;
  for (const auto& [module, heard] : heard_) {
    for (const channel_status_t& channel : heard.status.channels) {
      if (channel.num_lost == 0) continue;
      text += (text.empty() ? "" : "; ") + module + ": " + std::to_string(channel.num_lost) +
              " of " + std::to_string(channel.num_lost + channel.num_received) + " " +
              channel.channel;
    }
  }
  return text;
}

}  // namespace voqcal
