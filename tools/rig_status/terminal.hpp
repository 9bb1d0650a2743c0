#pragma once

#include <string>

#include <termios.h>

namespace voqcal {

/// The terminal that a page refreshes on: keys come one by one, unechoed, while it lives. Where
/// standard input is no terminal no key ever comes.
class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// The key that was pressed, or 0; does not wait.
  char Key() const;

  /// Puts the page in place of the one before, each line cut to the width, and the lines to the
  /// height unless `may_scroll`.
  void Show(const std::string& page, bool may_scroll) const;

 private:
  bool is_terminal_;
  termios before_{};
};

}  // namespace voqcal
