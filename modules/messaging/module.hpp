#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "messaging/message_error.hpp"

namespace voqcal {

/// One module of the flow, between the bus and core. Handlers convert and keep; Step computes.
class Module {
 public:
  virtual ~Module() = default;

  /// "lidar_board_detector", ...: its folder, its process and its name in MODULE_STATUS.
  virtual std::string Name() const = 0;

  /// Does one piece of work on the newest state. Called when no message waits, so that a burst of
  /// states costs one computation.
  /// @return true if there is more to do at once; false to wait for messages.
  virtual bool Step() { return false; }

  /// When Step wants to be called next although no message came (a driver's next frame); nothing if
  /// only messages give it work. Spin waits no longer than this.
  virtual std::optional<std::chrono::steady_clock::time_point> NextStep() const { return {}; }

  /// True once there will never be work again (the end of a recording): Spin then returns.
  virtual bool IsDone() const { return false; }

  /// No message comes any more and the process will end: waits for what goes on in other threads.
  virtual void WaitForThreads() {}

  /// Publishes the current state again. Called once a second: a lost datagram or a late start
  /// heals.
  virtual void Republish() {}

  /// In MODULE_STATUS: "running", "waiting ...", "trouble: what; remedy", "failed: ...".
  virtual std::string State() const { return "running"; }

  /// Results and misses by reason, for MODULE_STATUS and the closing line.
  const std::map<std::string, std::int64_t>& counters() const { return counters_; }

  /// "812 sweeps, 172 too few points": the totals, for the closing line.
  std::string Summary() const;

 protected:
  void Count(const std::string& what) { ++counters_[what]; }
  /// Does `work`, which reads messages that were kept. One that contradicts itself or the others
  /// costs that message only: it is counted, and the caller forgets the samples that it kept. They
  /// and what belongs to them come again within a second.
  /// @return whether all could be read.
  template <typename Work>
  bool CanRead(const Work& work) {
    try {
      work();
      return true;
    } catch (const MessageError& error) {
      CountUnreadable(error.what());
      return false;
    }
  }
  void SetCount(const std::string& what, std::int64_t count) { counters_[what] = count; }

 private:
  void CountUnreadable(const char* cause);

  std::map<std::string, std::int64_t> counters_;
};

}  // namespace voqcal
