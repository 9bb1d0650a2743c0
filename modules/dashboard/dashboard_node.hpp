#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dashboard/pair_page.hpp"
#include "dashboard/server.hpp"
#include "health/rig_health.hpp"
#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "rig/rig.hpp"
#include "voqcal/rig_extrinsics_t.hpp"

namespace voqcal {

/// Everything that the modules say in, pages out; and the other way, the operator's clicks as
/// CALIB_COMMAND. Of a rig of several sensors every pair has what a pair alone has (PairPage), of
/// which each page shows one, and the table of all.
class DashboardNode : public Module {
 public:
  /// @param pairs  one, or all of a rig; `server` has their names in this order.
  /// @param plan   of the session.
  /// @param bus, server  borrowed; must outlive the node.
  /// @param session_folder  the session's.
  DashboardNode(const std::vector<ShownPair>& pairs,
                const SessionPlan& plan,
                Bus* bus,
                DashboardServer* server,
                const std::filesystem::path& session_folder);

  std::string Name() const override { return "dashboard"; }
  std::string State() const override;
  bool Step() override;
  std::optional<std::chrono::steady_clock::time_point> NextStep() const override;
  void Republish() override;

 private:
  using Clock = std::chrono::steady_clock;

  void Subscribe();
  /// Each message of this channel of every pair to the pages of the pairs that have it. A sensor of
  /// several pairs is heard once.
  template <typename Message>
  void ToPages(std::string Channels::*channel,
               Queue queue,
               void (PairPage::*handler)(const Message&));
  /// Step is for when no message waits; under load that may be never.
  void StepIfDue();
  void TakeCommands();
  void SendCommand(const PageRequest& request);

  /// Faults are to be seen at once: more often than heartbeats come.
  void LookAtSessionIfDue();
  void ShowPairs(Clock::time_point now);
  /// What was heard of this pair, as far as it is of its session.
  PairRow RowOf(const PairPage& page, Clock::time_point now) const;
  /// What rig_calibrator said of it; null: nothing.
  const rig_pair_t* ResultOf(const Rig& rig) const;
  /// The name of the first of the pair's sensors whose stream is so.
  std::string SensorThatIs(Flow flow, const Rig& rig, Clock::time_point now) const;
  /// The pair that the operator is sent to: the weakest, unless that cannot be sampled.
  std::string NextPair(const std::vector<PairRow>& rows, Clock::time_point now);
  bool CanBeSampled(const Channels& channels, Clock::time_point now) const;

  Bus& bus_;
  DashboardServer& server_;
  std::filesystem::path session_folder_;
  RigHealth health_;
  std::vector<std::unique_ptr<PairPage>> pages_;
  std::vector<std::set<std::string>> names_of_others_;  ///< By page.
  std::optional<rig_extrinsics_t> rig_;
  std::optional<std::size_t> next_pair_;  ///< While the weakest cannot be sampled.
  Clock::time_point next_step_;
  Clock::time_point next_look_;
};

}  // namespace voqcal
