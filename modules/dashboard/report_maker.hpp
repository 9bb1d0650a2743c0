#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace voqcal {

/// Runs the program that makes a session's report. It computes for as long as the modules did: a
/// process of its own, beside whoever waits for it. The programs that it starts itself end with it.
class ReportMaker {
 public:
  /// @param command  the program's path, and what it is told.
  /// @param output  the file that gets what it says: whoever waits has last words of its own.
  /// @param patience  how long it may take to end once it is told to; then it is killed.
  ReportMaker(std::vector<std::string> command,
              const std::filesystem::path& output,
              std::chrono::milliseconds patience = std::chrono::seconds(5));
  /// Ends one that is at work.
  ~ReportMaker();
  ReportMaker(const ReportMaker&) = delete;
  ReportMaker& operator=(const ReportMaker&) = delete;

  /// Unless it is at work.
  /// @return false if the program cannot be run.
  bool Start();
  bool IsAtWork();

 private:
  /// With whatever it has started and left.
  void Kill();

  std::vector<std::string> command_;
  std::filesystem::path output_;
  std::chrono::milliseconds patience_;
  pid_t pid_ = -1;  ///< Also of its group of processes.
};

}  // namespace voqcal
