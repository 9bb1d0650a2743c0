#include "messaging/module.hpp"

#include <spdlog/spdlog.h>

namespace voqcal {

std::string Module::Summary() const {
  std::string text;
  for (const auto& [what, count] : counters_) {
    if (!text.empty()) text += ", ";
    text += std::to_string(count) + " " + what;
  }
  return text.empty() ? "nothing to count" : text;
}

void Module::CountUnreadable(const char* cause) {
  spdlog::debug("unreadable message: {}", cause);
  Count("unreadable message");
}

}  // namespace voqcal
