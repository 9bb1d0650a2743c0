#pragma once

#include <csignal>
#include <string>

#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "messaging/process.hpp"

namespace voqcal {

/// While it lives, SIGINT and SIGTERM set a flag instead of ending the process. A second signal of
/// the same kind ends it at once, so that a stuck process can still be interrupted. One at a time.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  bool IsRequested() const;

 private:
  struct sigaction previous_int_ {};
  struct sigaction previous_term_ {};
};

/// Runs a module until SIGINT, SIGTERM or its IsDone: handles messages while there are any, calls
/// Step when none waits (at NextStep at the latest), and once a second, by the steady clock,
/// Republish and a MODULE_STATUS. The last status says "stopped" or "done".
///
/// Ends within a second of the signal if Step and the handlers take no longer than that.
///
/// @param args  the session that the module serves, and what it is called there, for MODULE_STATUS.
/// @throws what Step, Republish or a handler throws, after a status "failed: ..." with its text.
void Spin(Bus& bus,
          Module& module,
          const std::string& status_channel,
          const ProcessArgs& args = {});

}  // namespace voqcal
