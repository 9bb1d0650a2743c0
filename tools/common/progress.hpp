#pragma once

#include <chrono>
#include <string>

namespace voqcal {

/// One line on the terminal that says how far long work is. Silent in the first second, and where
/// stderr is no terminal.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param share   done, 0 to 1.
  /// @param detail  e.g. "12 samples".
  void Show(double share, const std::string& detail);

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  bool is_terminal_;
  bool is_shown_ = false;
  Clock::time_point next_;
};

}  // namespace voqcal
