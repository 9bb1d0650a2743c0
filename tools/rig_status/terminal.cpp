#include "rig_status/terminal.hpp"

#include <cstdio>
#include <sstream>

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace voqcal {

Terminal::Terminal() : is_terminal_(tcgetattr(STDIN_FILENO, &before_) == 0) {
  if (!is_terminal_) return;
  termios one_by_one = before_;
  one_by_one.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  tcsetattr(STDIN_FILENO, TCSANOW, &one_by_one);
}

Terminal::~Terminal() {
  if (is_terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

char Terminal::Key() const {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (!is_terminal_ || poll(&input, 1, 0) <= 0) return 0;
  return read(STDIN_FILENO, &key, 1) == 1 ? key : static_cast<char>(0);
}

void Terminal::Show(const std::string& page, bool may_scroll) const {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) size = {};
  const std::size_t width = size.ws_col == 0 ? std::string::npos : size.ws_col;
  std::string shown = "\033[H\033[J";  // to the top left, and all away
  std::istringstream lines(page);
  int num_lines = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!may_scroll && size.ws_row != 0 && num_lines == size.ws_row) break;
    shown += (num_lines++ == 0 ? "" : "\n") + line.substr(0, width);
  }
  std::fputs(shown.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace voqcal
