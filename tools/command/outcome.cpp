#include "command/outcome.hpp"

#include <stdexcept>

namespace voqcal {

std::optional<std::string> OutcomeOf(const std::string& command,
                                     std::int64_t utime,
                                     const event_t& event) {
  const std::string sample = "sample " + std::to_string(event.sample_id);
  const bool is_captured = event.kind == "accepted" && event.reason.rfind("by command", 0) == 0;
  if (command == "capture" && is_captured) return sample + " taken " + event.reason;
  if (command == "finish" && event.kind == "finished") return "finished";
  if (event.utime != utime) return {};
  if (event.kind == "discarded") return sample + " discarded";
  if (event.kind == "reset") return "all samples taken away";
  if (event.kind == "rejected") throw std::runtime_error(event.reason);
  return {};
}

}  // namespace voqcal
