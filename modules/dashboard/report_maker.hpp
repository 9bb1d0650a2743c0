#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace voqcal {

/// Runs the program that makes a session's report. It computes for as long as the modules did: a
/// process of its own, beside whoever waits for it.
class ReportMaker {
 public:
  /// @param command  the program's path, and what it is told.
  /// @param output  the file that gets what it says: whoever waits has last words of its own.
  ReportMaker(std::vector<std::string> command, const std::filesystem::path& output);
  /// Ends one that is at work.
  ~ReportMaker();
  ReportMaker(const ReportMaker&) = delete;
  ReportMaker& operator=(const ReportMaker&) = delete;

  /// Unless it is at work.
  /// @return false if the program cannot be run.
  bool Start();
  bool IsAtWork();

 private:
  std::vector<std::string> command_;
  std::filesystem::path output_;
  pid_t pid_ = -1;
};

}  // namespace voqcal
