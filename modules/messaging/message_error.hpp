#pragma once

#include <stdexcept>

namespace voqcal {

/// A message that decodes but contradicts itself or those that belong to it: the fault of its
/// sender or of the way here, so it costs that message only.
struct MessageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace voqcal
