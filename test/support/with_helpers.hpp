#pragma once

#include <cstddef>

#include "core/parallel.hpp"

namespace voqcal::test {

/// While it lives, shared work has so many helpers, however many cores the machine has.
class WithHelpers {
 public:
  explicit WithHelpers(std::size_t num) : num_before_(Helpers::Shared().num()) {
    Helpers::Shared().SetNum(num);
  }
  ~WithHelpers() { Helpers::Shared().SetNum(num_before_); }
  WithHelpers(const WithHelpers&) = delete;
  WithHelpers& operator=(const WithHelpers&) = delete;

 private:
  std::size_t num_before_;
};

}  // namespace voqcal::test
