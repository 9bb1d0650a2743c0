#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace voqcal {

/// What a program says of itself in --help and in front of each log line.
struct ProcessInfo {
  std::string name;         ///< "lidar_board_detector".
  std::string description;  ///< One sentence: what it reads and what it writes.
};

/// The flags that every process takes.
struct ProcessArgs {
  std::filesystem::path rig_path;      ///< --rig FILE.
  std::optional<std::string> lcm_url;  ///< --lcm-url URL, instead of the rig file's.
  /// --session DIR, for modules that keep files.
  std::optional<std::filesystem::path> session_dir;
  /// --name NAME: what MODULE_STATUS and the log call it, where a rig of several sensors has more
  /// than one of it: "lidar_driver_front".
  std::optional<std::string> name;
  bool is_verbose = false;  ///< --verbose: log level debug.
};

/// The frame of every main(): reads the flags, sends spdlog to stderr under the module's name, runs
/// `body`, and prints its exception (PrintError). Memory that is freed stays with the process for
/// what comes next, at most 64 MB at the end of the heap.
///
/// @return the exit status: 0 when `body` returns (also after --help and --version); 1 when it
///     throws; 2 for flags that cannot be understood.
int RunProcess(int argc,
               const char* const* argv,
               const ProcessInfo& info,
               const std::function<void(const ProcessArgs&)>& body);

/// Sends spdlog to stderr, level info (debug if `is_verbose`), each line naming `program`.
void LogToStderr(const std::string& program, bool is_verbose);

/// Writes an error to stderr, each of its lines behind the program's name; one line also if it is
/// empty.
void PrintError(const std::string& program, const std::string& text);

}  // namespace voqcal
