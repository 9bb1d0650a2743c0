// status: what every module of a running rig says of itself, on one terminal page.

#include "messaging/status.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/tool_main.hpp"
#include "core/sensor_network/sensor_pair.hpp"
#include "health/session_watch.hpp"
#include "messaging/bus.hpp"
#include "messaging/session_name.hpp"
#include "messaging/spin.hpp"
#include "messaging/wall_clock.hpp"
#include "rig/rig.hpp"
#include "rig_status/status_page.hpp"
#include "rig_status/terminal.hpp"

namespace voqcal {
namespace {

using Clock = std::chrono::steady_clock;

struct StatusArgs {
  std::filesystem::path rig;
  std::optional<std::string> lcm_url;
  std::vector<std::string> modules;  ///< Empty: all.
  std::optional<std::filesystem::path> session;
  bool is_once = false;
  bool has_details = false;
  double starting_s = 0;
  std::optional<std::filesystem::path> take_for;
};

/// A heartbeat of each module, with room to spare.
constexpr std::chrono::milliseconds kProbeDuration{1500};
/// Who takes the network says so as often, and first hears for as long whether another does.
constexpr std::chrono::milliseconds kClaimPeriod{100};
constexpr int kNumClaimsBefore = 5;
/// Two heartbeats of each module: rates of sending need both.
constexpr std::chrono::milliseconds kOnceDuration{2500};
/// Of looks into the session's folder.
constexpr std::chrono::milliseconds kLookPeriod{500};

/// @throws UsageError for one that the session has not.
std::vector<std::string> ModulesOf(const StatusArgs& args, const SessionPlan& plan) {
  const std::vector<std::string>& all = plan.modules;
  for (const std::string& module : args.modules) {
    if (std::find(all.begin(), all.end(), module) != all.end()) continue;
    std::string names;
    for (const std::string& each : all) names += (names.empty() ? "" : ", ") + each;
    throw UsageError("--modules: no module '" + module + "'; there are " + names);
  }
  return args.modules;
}

/// Hears a rig and keeps its page.
class Listener {
 public:
  explicit Listener(const StatusArgs& args)
      : session_(args.session),
        pairs_(LoadPairs(args.rig)),
        plan_(PlanOfRig(args.rig, pairs_)),
        url_(args.lcm_url.value_or(pairs_.front().lcm_url)),
        bus_(url_),
        page_(plan_, ModulesOf(args, plan_), Clock::now()) {
    const Channels& channels = pairs_.front().channels;
    bus_.Subscribe<module_status_t>(
        channels.module_status, Queue::kEvery, [this](const module_status_t& m) {
          page_.Take(m, Clock::now());
        });
    for (const Rig& pair : pairs_) {
      const std::string name =
          pairs_.size() == 1 ? "" : PairName(pair.lidar_name, pair.camera_name);
      bus_.Subscribe<event_t>(pair.channels.calib_event,
                              Queue::kEvery,
                              [this, name](const event_t& m) { page_.Take(m, name); });
    }
    if (pairs_.size() == 1) return;
    bus_.Subscribe<rig_extrinsics_t>(channels.rig_extrinsics,
                                     Queue::kState,
                                     [this](const rig_extrinsics_t& m) { page_.Take(m); });
  }

  void Hear(std::chrono::milliseconds time) {
    const Clock::time_point end = Clock::now() + time;
    while (Clock::now() < end) {
      bus_.HandleOnce(std::chrono::milliseconds(100));
      if (session_ && Clock::now() >= next_look_) LookIntoTheSession();
    }
  }

  bool HaveAllSensorsSent() const {
    return std::all_of(plan_.streams.begin(), plan_.streams.end(), [this](const Stream& stream) {
      if (!stream.input.empty()) return true;  // a detector's
      const Flow flow = page_.health().FlowOf(stream.channel, Clock::now());
      return flow == Flow::kFlows || flow == Flow::kEnded;
    });
  }

  /// Says that these modules of a session are about to be started.
  void Claim(const std::vector<std::string>& modules, const std::string& session) {
    module_status_t message{};
    message.utime = WallClockUs();
    message.session = session;
    message.state = kToBeStarted;
    for (const std::string& module : modules) {
      message.module = module;
      bus_.Publish(pairs_.front().channels.module_status, message);
    }
  }

  const StatusPage& page() const { return page_; }
  const SessionPlan& plan() const { return plan_; }
  const std::string& url() const { return url_; }

 private:
  void LookIntoTheSession() {
    next_look_ = Clock::now() + kLookPeriod;
    page_.Take(ReadSession(*session_, std::time(nullptr)), Clock::now());
  }

  std::optional<std::filesystem::path> session_;
  std::vector<Rig> pairs_;
  SessionPlan plan_;
  std::string url_;
  Bus bus_;
  StatusPage page_;
  Clock::time_point next_look_;
};

void PrintOnce(const StatusArgs& args) {
  Listener listener(args);
  listener.Hear(kOnceDuration);
  const StatusPage& page = listener.page();
  const Clock::time_point now = Clock::now();
  std::fputs((args.has_details ? page.Details(now) : page.Text(now)).c_str(), stdout);
  if (!page.IsAllGood(now)) {
    throw std::runtime_error(args.rig.string() + ": not all is well");
  }
}

/// Returns once all modules run and both sensors send; at the latest after args.starting_s, and
/// then with what is wrong.
void PrintFaultsOfStart(const StatusArgs& args) {
  Listener listener(args);
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(args.starting_s));
  do {
    listener.Hear(std::chrono::milliseconds(200));
    const bool is_well = listener.page().IsAllGood(Clock::now());
    if (is_well && listener.HaveAllSensorsSent()) return;
  } while (Clock::now() < end);
  std::string faults;
  for (const Fault& fault : listener.page().health().Faults(Clock::now())) {
    if (fault.is_grave) faults += ToString(fault) + '\n';
  }
  if (!faults.empty()) throw std::runtime_error(faults);
}

/// @throws std::runtime_error if another session runs any of the modules on this network, or is
/// about to.
void RequireNoRival(const Listener& listener,
                    const std::vector<std::string>& modules,
                    const std::string& session) {
  std::string problems;
  for (const std::string& rival : listener.page().health().heartbeats().Rivals(
           Clock::now(), session, listener.plan().folders)) {
    const std::string module = rival.substr(0, rival.find(' '));
    const bool is_same = std::any_of(modules.begin(), modules.end(), [&](const std::string& own) {
      // One of a pair, and one of several such of a rig, hear the same commands.
      return own == module || own == ModuleOf(module) || ModuleOf(own) == module;
    });
    if (!is_same) continue;
    problems += listener.url() + ": " + rival + '\n';
  }
  if (problems.empty()) return;
  throw std::runtime_error(
      problems +
      "two sessions would mix their samples: stop the other one (tools/down), or give this rig "
      "another port in lcm.url");
}

/// Hears whether the network is free, takes it, and says "taken"; then says on the network that it
/// is, until SIGTERM, so that of two sessions that start at once neither reads what the other
/// sends.
void TakeNetwork(const StatusArgs& args) {
  const StopOnSignal stop;
  const std::string session = SessionName(*args.take_for);
  Listener listener(args);
  const std::vector<std::string> modules =
      args.modules.empty() ? listener.plan().modules : args.modules;
  listener.Hear(kProbeDuration);
  RequireNoRival(listener, modules, session);
  for (int num_claims = 0; !stop.IsRequested(); ++num_claims) {
    if (num_claims == kNumClaimsBefore) {
      std::puts("taken");
      std::fflush(stdout);
    }
    listener.Claim(modules, session);
    listener.Hear(kClaimPeriod);
    RequireNoRival(listener, modules, session);
  }
}

/// Until q or Ctrl-C.
void PrintEachSecond(const StatusArgs& args) {
  const StopOnSignal stop;
  const Terminal terminal;
  Listener listener(args);
  bool has_details = args.has_details;
  for (int tick = 0; !stop.IsRequested(); ++tick) {
    listener.Hear(std::chrono::milliseconds(100));
    const char key = terminal.Key();
    if (key == 'q') return;
    if (key == 'd') has_details = !has_details;
    if (tick % 10 != 0 && key != 'd') continue;
    const StatusPage& page = listener.page();
    const Clock::time_point now = Clock::now();
    terminal.Show((has_details ? page.Details(now) : page.Text(now)) + "d: details  q: end",
                  has_details);
  }
}

void ShowStatus(const StatusArgs& args) {
  if (args.take_for) return TakeNetwork(args);
  if (args.starting_s > 0) return PrintFaultsOfStart(args);
  if (args.is_once) return PrintOnce(args);
  PrintEachSecond(args);
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Shows every module of a running rig: state, rates, losses, results and misses by reason.",
      "status");
  voqcal::StatusArgs args;
  app.add_option("rig", args.rig, "The rig file (YAML)")->required();
  app.add_option("--lcm-url", args.lcm_url, "Instead of the rig file's");
  app.add_option(
         "--modules",
         args.modules,
         "Those that should be heard; without it those that the session runs on this host, or "
         "all")
      ->delimiter(',');
  app.add_option("--session",
                 args.session,
                 "Its folder on this host: tells which programs ended, and of recording and disk");
  app.add_flag("--details", args.has_details, "Each channel, loss and count (the key d)");
  app.add_flag("--once",
               args.is_once,
               "Listen for 2.5 s, print one page; status 1 if anything is wrong, or if messages "
               "were lost");
  app.add_option("--starting",
                 args.starting_s,
                 "Wait so many seconds for all modules to run and all sensors to send; print only "
                 "what is wrong then, with status 1");
  app.add_option("--take-for",
                 args.take_for,
                 "For up: take the network for this session folder's modules, print \"taken\", "
                 "hold it until SIGTERM; status 1 and who it is if another session has it");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::ShowStatus(args); });
}
