#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/expected.hpp"
#include "dashboard/slot.hpp"

namespace voqcal {

/// What a page asks for: one of the three.
struct PageRequest {
  std::string command;         ///< "capture", "discard", "finish", "reset"; empty: it is the other.
  std::int64_t sample_id = 0;  ///< Of discard; 0: the newest.
  std::string pair;            ///< Which the command is for; empty: all that there are.
  std::string watch;           ///< From now on the page shows this pair; empty: it is another.
  Slot shown = Slot::kImage;   ///< The page has drawn this frame and can take the next.
};

/// Longer requests are refused before they are read: the longest that means something has 50 bytes.
inline constexpr std::size_t kMaxRequestBytes = 1024;

/// Reads one request:
///     {"command": "discard", "sample_id": 7}    {"shown": "image"}
/// and of a rig of several pairs
///     {"command": "capture", "pair": "front_left"}    {"watch": "front_left"}
/// @return the request, or why it is refused.
Expected<PageRequest, std::string> ParsePageRequest(std::string_view text);

}  // namespace voqcal
