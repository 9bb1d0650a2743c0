#include "common/progress.hpp"

#include <cstdio>
#include <utility>

#include <unistd.h>

namespace voqcal {

Progress::Progress(std::string what)
    : what_(std::move(what)),
      is_terminal_(isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + std::chrono::seconds(1)) {}

Progress::~Progress() {
  if (is_shown_) std::fputs("\r\033[K", stderr);
}

void Progress::Show(double share, const std::string& detail) {
  if (!is_terminal_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
  is_shown_ = true;
  std::fprintf(stderr, "\r\033[K%s: %3.0f %%, %s", what_.c_str(), 100 * share, detail.c_str());
  std::fflush(stderr);
}

}  // namespace voqcal
