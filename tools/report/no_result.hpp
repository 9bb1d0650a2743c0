#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Writes no_result.html: why there is no calibration, what was seen instead, each frame with its
/// reason, and what to do.
///
/// @param problem  in one line; lines below it are advice.
/// @param samples  those that there are.
/// @param session  where samples.lcm (their scenes) and misses.lcm are.
/// @param folder   where the page goes; made if missing.
/// @return why there is none (no Python, no jinja2, ...); empty if there is one.
std::string WriteNoResult(const Rig& rig,
                          const std::string& problem,
                          const std::vector<BoardSample>& samples,
                          const std::filesystem::path& session,
                          const std::filesystem::path& folder);

}  // namespace voqcal
