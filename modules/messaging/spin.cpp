#include "messaging/spin.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>

#include "messaging/session_name.hpp"
#include "messaging/status.hpp"

namespace voqcal {
namespace {

using Clock = StatusPublisher::Clock;
using std::chrono::milliseconds;

constexpr std::chrono::seconds kStatusPeriod{1};

/// The longest sleep. A signal may reach LCM's thread instead of this one and then wakes nobody.
constexpr milliseconds kMaxWait{100};

volatile std::sig_atomic_t g_is_stop_requested = 0;

void RequestStop(int /*signal*/) { g_is_stop_requested = 1; }

/// Republish and status whenever a second has passed.
class Heartbeat {
 public:
  Heartbeat(Bus& bus, Module& module, const std::string& channel, const ProcessArgs& args)
      : module_(module),
        status_(bus, channel, args.session_dir.value_or(""), args.name.value_or(module.Name())) {}

  void BeatIfDue() {
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    module_.Republish();
    status_.Publish(module_, module_.State(), now);
    // After a long Step the missed beats are left out, not made up for.
    next_ += kStatusPeriod;
    if (next_ <= now) next_ = now + kStatusPeriod;
  }

  Clock::time_point next() const { return next_; }

  void Beat(const std::string& state) { status_.Publish(module_, state); }

 private:
  Module& module_;
  StatusPublisher status_;
  Clock::time_point next_ = Clock::now();
};

/// How long the module may sleep if no message comes.
milliseconds IdleWait(const Module& module, Clock::time_point next_beat) {
  Clock::time_point wake = next_beat;
  if (const auto next_step = module.NextStep()) wake = std::min(wake, *next_step);
  // Rounded up: waking a fraction too early would spin through the last millisecond.
  const auto wait = std::chrono::ceil<milliseconds>(wake - Clock::now());
  return std::clamp(wait, milliseconds(0), kMaxWait);
}

void RunUntilStopped(Bus& bus, Module& module, const StopOnSignal& stop, Heartbeat* heartbeat) {
  bool has_more_to_do = false;
  while (!stop.IsRequested() && !module.IsDone()) {
    heartbeat->BeatIfDue();
    const milliseconds wait =
        has_more_to_do ? milliseconds(0) : IdleWait(module, heartbeat->next());
    if (bus.HandleOnce(wait)) {
      has_more_to_do = true;  // see at once whether another message waits
    } else {
      has_more_to_do = module.Step();
    }
  }
}

}  // namespace

StopOnSignal::StopOnSignal() {
  g_is_stop_requested = 0;
  struct sigaction action {};
  action.sa_handler = &RequestStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // no SA_RESTART: waits end early
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &previous_int_);
  sigaction(SIGTERM, &action, &previous_term_);
}

StopOnSignal::~StopOnSignal() {
  sigaction(SIGINT, &previous_int_, nullptr);
  sigaction(SIGTERM, &previous_term_, nullptr);
}

bool StopOnSignal::IsRequested() const { return g_is_stop_requested != 0; }

void Spin(Bus& bus, Module& module, const std::string& status_channel, const ProcessArgs& args) {
  const StopOnSignal stop;
  bus.SetSession(SessionName(args.session_dir.value_or("")));
  Heartbeat heartbeat(bus, module, status_channel, args);
  try {
    RunUntilStopped(bus, module, stop, &heartbeat);
    module.WaitForThreads();
  } catch (const std::exception& error) {
    heartbeat.Beat(std::string("failed: ") + error.what());
    throw;
  }
  heartbeat.Beat(stop.IsRequested() ? "stopped" : "done");
}

}  // namespace voqcal
