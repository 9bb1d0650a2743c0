#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "health/fault.hpp"
#include "health/heartbeats.hpp"
#include "health/session_watch.hpp"
#include "rig/rig.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// How a module is: silent after three seconds without a heartbeat, unless its last one said that
/// it has ended.
enum class ModuleHealth { kGood, kEnded, kSilent, kFailed };

/// "good", "ended", "silent", "failed".
const char* ToString(ModuleHealth health);

/// What comes of a stream of frames.
enum class Flow { kNothingYet, kFlows, kSilent, kEnded };

/// "nothing yet", "flows", "silent", "ended".
const char* ToString(Flow flow);

/// Judges a rig by its modules' heartbeats and by what its host knows. No bus and no clock: the
/// caller tells the time.
class RigHealth {
 public:
  using Time = HeardModule::Time;

  /// @param plan     of the session.
  /// @param modules  those that should be heard, besides what the session's supervisor runs.
  /// @param begin    from when on every heartbeat is taken.
  RigHealth(const SessionPlan& plan, std::vector<std::string> modules, Time begin);

  void Take(const module_status_t& status, Time now) { heartbeats_.Take(status, now); }
  void Take(const SessionFacts& facts, Time now);

  /// From now on these should be heard; and that comes which those that are heard read, wherever it
  /// is sent.
  void Expect(std::vector<std::string> modules);

  /// What is wrong, the gravest first; each cause once.
  std::vector<Fault> Faults(Time now) const;

  ModuleHealth HealthOf(const std::string& module, Time now) const;
  /// Of a module that has ended: "done", or "stopped" by somebody.
  std::string HowEnded(const std::string& module) const;
  /// Of one of the channels that samples are made of.
  Flow FlowOf(const std::string& channel, Time now) const;

  const Heartbeats& heartbeats() const { return heartbeats_; }

 private:
  const Stream* StreamOfSender(const std::string& module) const;
  bool IsExpected(const std::string& module) const;
  /// This host's session is without it; another's may have it.
  bool IsElsewhere(const std::string& module) const;
  bool HasEndedWell(const std::string& module) const;
  const ProgramFacts* ProgramOf(const std::string& name) const;

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

  Heartbeats heartbeats_;
  std::vector<std::string> all_modules_;  ///< Of the session.
  std::vector<std::string> modules_;
  bool are_streams_expected_ = false;  ///< Also those of senders that are not.
  Time begin_;
  SessionFacts facts_;
  Time last_recorded_{};  ///< When the recording was last seen to grow.
};

}  // namespace voqcal
