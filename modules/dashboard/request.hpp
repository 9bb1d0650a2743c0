#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/expected.hpp"
#include "dashboard/slot.hpp"

namespace voqcal {

/// What a page asks for: a command, a pair to watch, or the next frame.
struct PageRequest {
  std::string command;         ///< "capture", "discard", "finish", "reset"; empty: no command.
  std::int64_t sample_id = 0;  ///< Of discard; 0: the newest.
  std::string pair;            ///< Which the command is for; empty: all that there are.
  std::string watch;           ///< From now on the page shows this pair; empty: none is asked for.
  Slot shown = Slot::kImage;   ///< The page has drawn this frame and can take the next.
};

/// Longer requests are refused before they are read: those that mean something have some tens of
/// bytes and the name of a pair.
inline constexpr std::size_t kMaxRequestBytes = 1024;

/// Reads one request:
///     {"command": "discard", "sample_id": 7}    {"shown": "image"}
/// and of a rig of several pairs
///     {"command": "capture", "pair": "front_left"}    {"watch": "front_left"}
/// @return the request, or why it is refused.
Expected<PageRequest, std::string> ParsePageRequest(std::string_view text);

}  // namespace voqcal
