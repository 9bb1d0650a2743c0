#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "health/session_programs.hpp"
#include "rig/rig.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// The state in a heartbeat that tools/up sends for a module that it is about to start: the network
/// is taken before anything on it could read another session's messages.
inline constexpr char kToBeStarted[] = "to be started";

/// A module as its heartbeats tell.
struct HeardModule {
  using Time = std::chrono::steady_clock::time_point;

  module_status_t status;
  Time at;                                 ///< Of the last heartbeat.
  double published_hz = 0;                 ///< Between the last two.
  int num_restarts = 0;                    ///< Times that the numbering began anew.
  std::map<std::string, Time> sessions{};  ///< That send it, each with its last heartbeat.

  /// It said so itself.
  bool HasEnded() const;
  /// No heartbeat for three seconds.
  bool IsSilent(Time now) const;
};

/// A channel that samples are made of, as its readers count it.
struct Stream {
  std::string channel;
  std::string sender;       ///< The module that sends it.
  std::string name;         ///< "lidar", "camera"; of a detector its module's name.
  std::string input;        ///< The channel that the sender reads; empty: it is a sensor's driver.
  bool has_reader = false;  ///< Of those heard; else nobody here can say whether it comes.
  bool has_come = false;    ///< While its readers were heard...
  bool has_come_before = false;  ///< ...or before: they had counted it.
  HeardModule::Time last_news{};
  double usual_gap_s = 0;
};

/// What a session is made of.
struct SessionPlan {
  std::vector<std::string> modules;  ///< By their names in it, in the order of the flow.
  std::vector<Stream> streams;       ///< Of its sensors, then of their detectors.
  std::vector<std::string> folders;  ///< Of its pairs, within its own: sessions of its modules.
};
SessionPlan PlanOfPair(const Channels& channels);
/// @param pairs  LoadPairs of it.
SessionPlan PlanOfRig(const std::filesystem::path& rig, const std::vector<Rig>& pairs);

double SecondsBetween(HeardModule::Time from, HeardModule::Time to);

/// What the modules' heartbeats tell. No bus and no clock: the caller tells the time.
class Heartbeats {
 public:
  using Time = HeardModule::Time;

  explicit Heartbeats(std::vector<Stream> streams = {}) : streams_(std::move(streams)) {}

  void Take(const module_status_t& status, Time now);

  /// Null if it was never heard.
  const HeardModule* Find(const std::string& module) const;
  /// By name.
  const std::map<std::string, HeardModule>& heard() const { return heard_; }
  /// Of the sensors, then of their detectors.
  const std::vector<Stream>& streams() const { return streams_; }

  /// A sentence for each module that sends or collects and that sessions other than `own` run, or
  /// are about to start, on this network; none: it is free. With no `own`: for each such module
  /// that more than one session runs.
  /// @param folders  within `own`, that are its pairs' (SessionPlan).
  std::vector<std::string> Rivals(Time now,
                                  const std::string& own = {},
                                  const std::vector<std::string>& folders = {}) const;

  /// "lidar_board_detector: 5 of 100 LIDAR_POINTS; ...": empty if nothing was lost.
  std::string Losses() const;
  /// When more was last lost.
  const std::optional<Time>& last_loss() const { return last_loss_; }

 private:
  void NoteNews(const module_status_t& status, const HeardModule* before, Time now);
  void NoteLosses(const module_status_t& status, const HeardModule* before, Time now);

  std::vector<Stream> streams_;
  std::map<std::string, HeardModule> heard_;
  std::map<std::string, std::map<std::string, Time>>
      to_be_started_;  ///< Module, session: last told.
  std::optional<Time> last_loss_;
};

}  // namespace voqcal
