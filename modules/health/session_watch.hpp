#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "health/supervisor_log.hpp"

namespace voqcal {

/// A program of a session, under this host's supervisor.
struct ProgramFacts {
  ProgramHistory history;
  std::time_t running_s = 0;  ///< Since it was started; 0 if it does not run.
  int num_ends_lately = 0;    ///< Unexpected ones of the last half minute.
  std::string last_words;     ///< The last line that it wrote; may be empty.
};

enum class SupervisorState { kRuns, kHalted, kDead };

/// What this host knows of a session.
struct SessionFacts {
  bool is_supervised = false;  ///< tools/up started it here, and nobody stopped it.
  SupervisorState supervisor = SupervisorState::kRuns;  ///< If it is supervised.
  std::map<std::string, ProgramFacts> programs;         ///< By name; the recorder is "lcm-logger".
  std::optional<std::int64_t> num_recorded_bytes;  ///< Of the newest raw*.lcm, if there is one.
  std::optional<std::int64_t> num_free_bytes;      ///< Of the folder's disk.
};

inline constexpr char kRecorder[] = "lcm-logger";

/// Reads a session's folder as tools/up and its supervisor leave it. Files that are not there or
/// cannot be read tell nothing: this is no place to fail.
/// @param now  by the wall clock.
SessionFacts ReadSession(const std::filesystem::path& folder, std::time_t now);

}  // namespace voqcal
