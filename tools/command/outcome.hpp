#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "voqcal/event_t.hpp"

namespace voqcal {

/// What an event says of the command that was sent at `utime`; nothing if it is about another
/// thing. A sample that was accepted by itself is not what "capture" asked for.
/// @throws std::runtime_error with the reason, if the collector refused it.
std::optional<std::string> OutcomeOf(const std::string& command,
                                     std::int64_t utime,
                                     const event_t& event);

}  // namespace voqcal
