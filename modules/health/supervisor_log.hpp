#pragma once

#include <ctime>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace voqcal {

/// What supervisord's log says of one program.
struct ProgramHistory {
  bool is_running = false;
  bool has_given_up = false;    ///< It ended so often that it is not started again.
  bool has_ended_well = false;  ///< By itself, with status 0, as drivers do.
  bool was_stopped = false;     ///< As it was asked to.
  std::string how_ended;    ///< The last time: "exit status 1", "terminated by SIGKILL"; or empty.
  std::time_t started = 0;  ///< The last time.
  std::vector<std::time_t> unexpected_ends;
};

/// @param log  lines of supervisord.log, the oldest first; those that say nothing of a program are
///     left out.
std::map<std::string, ProgramHistory> ReadSupervisorLog(const std::string& log);

/// The names in supervisor.conf: what is to run.
std::vector<std::string> ProgramsOf(const std::string& supervisor_conf);

}  // namespace voqcal
