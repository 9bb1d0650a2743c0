#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "messaging/bus.hpp"
#include "messaging/module.hpp"
#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// Sends one module's MODULE_STATUS; remembers what numbering and rates need. Spin uses it; a
/// process with a loop of its own uses it alone.
class StatusPublisher {
 public:
  using Clock = std::chrono::steady_clock;

  /// Borrows `bus`, which must outlive it.
  /// @param session_dir  of the session that the module serves; empty: of none.
  /// @param name         of the module there; empty: Module::Name.
  StatusPublisher(Bus& bus,
                  std::string channel,
                  const std::filesystem::path& session_dir = {},
                  std::string name = {});

  /// @param state  usually module.State(); "failed: ..." when it can do no more.
  /// @param now    rates are counted from the previous call's `now` to this one; 0 in the first.
  void Publish(const Module& module,
               const std::string& state,
               Clock::time_point now = Clock::now());

 private:
  double RateHz(const std::string& channel, std::int64_t num_received, Clock::time_point now);

  Bus& bus_;
  std::string channel_;
  std::string session_;
  std::string name_;
  std::int64_t num_sent_ = 0;
  Clock::time_point last_;
  std::map<std::string, std::int64_t> num_received_;  ///< At the previous call.
};

}  // namespace voqcal
