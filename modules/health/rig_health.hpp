#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "health/fault.hpp"
#include "health/session_watch.hpp"
#include "rig/rig.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// Every module of the flow, in its order.
std::vector<std::string> AllModuleNames();

/// How a module is: silent after three seconds without a heartbeat, unless its last one said that
/// it has ended.
enum class ModuleHealth { kGood, kEnded, kSilent, kFailed };

/// "good", "ended", "silent", "failed".
const char* ToString(ModuleHealth health);

/// What comes of a stream of frames.
enum class Flow { kNothingYet, kFlows, kSilent, kEnded };

/// "nothing yet", "flows", "silent", "ended".
const char* ToString(Flow flow);

/// A module as its heartbeats tell.
struct HeardModule {
  using Time = std::chrono::steady_clock::time_point;

  module_status_t status;
  Time at;                                 ///< Of the last heartbeat.
  double published_hz = 0;                 ///< Between the last two.
  int num_restarts = 0;                    ///< Times that the numbering began anew.
  std::map<std::string, Time> sessions{};  ///< That send it, each with its last heartbeat.
};

/// Judges a rig by its modules' heartbeats and by what its host knows. No bus and no clock: the
/// caller tells the time.
class RigHealth {
 public:
  using Time = HeardModule::Time;

  /// @param channels  those of the rig.
  /// @param modules   those that should be heard, besides what the session's supervisor runs.
  /// @param begin     from when on every heartbeat is taken.
  RigHealth(const Channels& channels, std::vector<std::string> modules, Time begin);

  void Take(const module_status_t& status, Time now);
  void Take(const SessionFacts& facts, Time now);

  /// What is wrong, the gravest first; each cause once.
  std::vector<Fault> Faults(Time now) const;

  ModuleHealth HealthOf(const std::string& module, Time now) const;
  /// Of one of the four channels that samples are made of.
  Flow FlowOf(const std::string& channel, Time now) const;

  /// A sentence for each module that sessions other than `own` run on this network; none: it is
  /// free. With no `own`: for each module that more than one session runs.
  std::vector<std::string> Rivals(Time now, const std::string& own = {}) const;

  /// "lidar_board_detector: 5 of 100 LIDAR_POINTS; ...": empty if nothing was lost.
  std::string Losses() const;

  /// By name.
  const std::map<std::string, HeardModule>& heard() const { return heard_; }

 private:
  /// A channel as its readers count it.
  struct Stream {
    std::string channel;
    std::string sender;  ///< The module that sends it.
    std::string name;    ///< "lidar", "camera"; of a detector its module's name.
    bool has_come = false;
    Time last_news{};
    double usual_gap_s = 0;
  };

  void NoteNews(const module_status_t& status, const HeardModule* before, Time now);
  void NoteLosses(const module_status_t& status, const HeardModule* before, Time now);
  const Stream* StreamOfSender(const std::string& module) const;
  bool IsExpected(const std::string& module) const;
  bool HasEndedWell(const std::string& module) const;
  const ProgramFacts* ProgramOf(const std::string& name) const;
  std::vector<std::string> SessionsOf(const HeardModule& heard, Time now) const;

  void AddDiskFault(std::vector<Fault>* faults) const;
  void AddSupervisorFault(std::vector<Fault>* faults) const;
  void AddRivals(Time now, std::vector<Fault>* faults) const;
  void AddStreamFaults(Time now, std::vector<Fault>* faults) const;
  void AddTroubles(Time now, std::vector<Fault>* faults) const;
  void AddModuleFaults(Time now, std::vector<Fault>* faults) const;
  void AddRecorderFault(Time now, std::vector<Fault>* faults) const;
  void AddRestarts(std::vector<Fault>* faults) const;
  void AddLosses(Time now, std::vector<Fault>* faults) const;

  Flow FlowOf(const Stream& stream, Time now) const;
  /// It may still come: its program was only just started.
  bool IsStarting(const std::string& module, Time now) const;
  /// Its program ended and was not started again, or it said that it has failed.
  bool IsDown(const std::string& module, Time now) const;
  /// Why a sender sends nothing, as far as it is known; empty if it seems well.
  std::string CauseAt(const std::string& module, Time now) const;

  std::vector<std::string> modules_;
  std::vector<Stream> streams_;
  std::map<std::string, HeardModule> heard_;
  Time begin_;
  std::optional<Time> last_loss_;
  SessionFacts facts_;
  Time last_recorded_{};  ///< When the recording was last seen to grow.
};

}  // namespace voqcal
