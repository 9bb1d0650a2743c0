#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "voqcal/event_t.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// Every module of the flow, in its order.
std::vector<std::string> AllModuleNames();

/// Collects the heartbeats of a rig's modules and writes them as one terminal page. No bus and no
/// clock: the caller tells the time.
class StatusPage {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param modules  those that should be heard, in the page's order. Others are listed too.
  /// @param ended    those that are known to have ended as planned; heard, they count as heard.
  explicit StatusPage(std::vector<std::string> modules, std::vector<std::string> ended = {});

  void Take(const module_status_t& status, Time now);
  void Take(const event_t& event);

  /// How a module is: silent after three seconds without a heartbeat, unless its last one said that
  /// it has ended.
  enum class Health { kGood, kSilent, kFailed };
  Health HealthOf(const std::string& module, Time now) const;

  /// True if each module that should be heard is good, none is sent by two sessions, and no message
  /// was lost.
  bool IsAllGood(Time now) const;

  /// A sentence for each module that sessions other than `own` run on this network; none: it is
  /// free. With no `own`: for each module that more than one session runs.
  std::vector<std::string> Rivals(Time now, const std::string& own = {}) const;

  /// A line or more for each module (state, rates, losses, most frequent results and misses), the
  /// last events, then one line each for who is silent and for what was lost.
  std::string Text(Time now) const;

 private:
  struct Heard {
    module_status_t status;
    Time at;
    double published_hz = 0;                 ///< Between the last two heartbeats.
    int num_restarts = 0;                    ///< Times that the numbering began anew.
    std::map<std::string, Time> sessions{};  ///< That send it, each with its last heartbeat.
  };

  std::string ModuleText(const std::string& module, Time now) const;
  std::string SilentText(Time now) const;
  std::string LostText() const;  ///< Empty if nothing was.
  /// The sessions that sent this module's heartbeat in the last three seconds.
  std::vector<std::string> SessionsOf(const Heard& heard, Time now) const;
  bool IsKnownToHaveEnded(const std::string& module) const;

  std::vector<std::string> modules_;
  std::vector<std::string> ended_;
  std::map<std::string, Heard> heard_;
  std::deque<event_t> events_;  ///< The newest last.
};

}  // namespace voqcal
