#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "health/rig_health.hpp"
#include "voqcal/event_t.hpp"
#include "voqcal/rig_extrinsics_t.hpp"

namespace voqcal {

/// Writes the health of a rig as one terminal page. No bus and no clock: the caller tells the time.
class StatusPage {
 public:
  using Time = RigHealth::Time;

  /// @param modules  those that should be heard, in the page's order. Others are listed too. Empty:
  /// those of the session that runs on this host; without one, all.
  StatusPage(const SessionPlan& plan, std::vector<std::string> modules, Time begin);

  void Take(const module_status_t& status, Time now) { health_.Take(status, now); }
  void Take(const SessionFacts& facts, Time now);
  /// @param of  the pair that it is of, where there are several; else empty.
  void Take(const event_t& event, const std::string& of = {});
  void Take(const rig_extrinsics_t& message) { rig_ = message; }

  /// True if each module that should be heard is well, there is no grave fault and nothing was
  /// lost.
  bool IsAllGood(Time now) const;

  /// What is wrong, then a line for each module, of several sensors the table of their pairs, the
  /// last events, who is silent and what was lost: of a pair, a terminal of 24 rows holds it.
  std::string Text(Time now) const;

  /// The same with all faults, and some lines for each module: rates of each channel, losses, most
  /// frequent results and misses.
  std::string Details(Time now) const;

  const RigHealth& health() const { return health_; }

 private:
  std::vector<std::string> Listed() const;
  std::string FaultsText(Time now, std::size_t max_faults) const;
  std::string EventsText(std::size_t max_events) const;
  int NameWidth() const;
  std::string LineOf(const std::string& module, Time now) const;
  std::string DetailsOf(const std::string& module) const;
  std::string LastLines(Time now) const;

  std::vector<std::string> all_modules_;  ///< Of the session.
  bool are_modules_given_;
  std::vector<std::string> modules_;  ///< That should be heard.
  RigHealth health_;
  std::deque<std::string> events_;  ///< As lines, the newest last.
  std::optional<rig_extrinsics_t> rig_;
};

}  // namespace voqcal
