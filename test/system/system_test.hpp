#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include "rig/rig.hpp"

namespace voqcal::test {

/// How a command ended, and what it wrote.
struct Outcome {
  int status = -1;  ///< Exit status; 128 + the signal's number if one ended it.
  std::string out;
  std::string err;
};

/// Runs a program to its end: no shell, so that no argument needs quotes.
/// @param args  the program (Program, Tool) and its arguments.
Outcome Run(const std::vector<std::string>& args);

/// build/PRESET/bin/NAME, and tools/NAME.
std::string Program(const std::string& name);
std::string Tool(const std::string& name);

/// A program in the background. Killed if the test ends before it.
class Process {
 public:
  /// @param output  the file that gets what it writes to stdout and stderr.
  Process(const std::vector<std::string>& args, const std::filesystem::path& output);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void Signal(int signal) const;
  int Wait();  ///< Exit status, as Outcome has it.

 private:
  pid_t pid_ = -1;
};

/// The names in a folder, sorted.
std::vector<std::string> NamesIn(const std::filesystem::path& folder);

/// `text` with its one `from` made `to`.
/// @throws std::logic_error if it has none or several.
std::string Replaced(const std::string& text, const std::string& from, const std::string& to);

/// The text of config/rigs/simulated_vlp16.yaml.
std::string SimulatedRigText();

/// The same rig made short and small, for live runs of ten seconds: 8 near stops of 0.8 s, 5 frames
/// a second, images of 640 x 400.
std::string ShortRigText();

/// config/rigs/simulated_several.yaml made short and small: 12 near stops, images of 640 x 400,
/// lidars of few points.
std::string SmallRigOfSeveralText();

}  // namespace voqcal::test
