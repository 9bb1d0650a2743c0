#include "health/fault.hpp"

namespace voqcal {

std::string ToString(const Fault& fault) {
  return fault.what + (fault.cause.empty() ? "" : ": " + fault.cause) + ". " + fault.remedy;
}

}  // namespace voqcal
