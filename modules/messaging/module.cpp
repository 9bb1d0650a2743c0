#include "messaging/module.hpp"

namespace voqcal {

std::string Module::Summary() const {
  std::string text;
  for (const auto& [what, count] : counters_) {
    if (!text.empty()) text += ", ";
    text += std::to_string(count) + " " + what;
  }
  return text.empty() ? "nothing to count" : text;
}

}  // namespace voqcal
