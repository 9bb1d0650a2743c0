#pragma once

#include <array>
#include <csetjmp>
#include <cstdio>
#include <stdexcept>

namespace voqcal {

/// Why a C library failed, and where to go on. Its error handler, which must not return, fills in
/// the cause and jumps.
struct CFailure {
  std::jmp_buf return_point;
  std::array<char, 256> cause{};

  [[noreturn]] void Jump(const char* text) {
    std::snprintf(cause.data(), cause.size(), "%s", text);
    std::longjmp(return_point, 1);
  }
};

/// Calls steps().
///
/// A failure jumps over what `steps` has on its stack, so there must be no object with a
/// destructor.
/// @throws std::runtime_error with the cause.
template <typename Steps>
void CallC(CFailure* failure, const Steps& steps) {
  if (setjmp(failure->return_point) != 0) throw std::runtime_error(failure->cause.data());
  steps();
}

}  // namespace voqcal
