#pragma once

#include <chrono>
#include <cstdint>

namespace voqcal {

/// When a message is sent, us since the Unix epoch. No result is computed from it.
inline std::int64_t WallClockUs() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace voqcal
