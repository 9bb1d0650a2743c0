#pragma once

#include <chrono>
#include <map>
#include <string>

#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// The modules that were heard, how they are and what they lost. No clock: the caller tells the
/// time.
class Heartbeats {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void Take(const module_status_t& status, Time now);

  /// For the page: name, state, health ("good", "silent", "failed"), number of lost messages.
  std::string Json(Time now) const;

 private:
  struct Heard {
    module_status_t status;
    Time at;
  };
  std::map<std::string, Heard> heard_;
};

}  // namespace voqcal
