#pragma once

#include <functional>
#include <stdexcept>

#include <CLI/CLI.hpp>

namespace voqcal {

/// All was done, but the outcome is not what the flags demand.
struct DemandNotMet : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Flags whose fault only shows by what they name.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The frame of every tool's main(): reads the flags that `app` has (and --version), runs `body`,
/// and prints its exception (PrintError).
///
/// @return the exit status: 0; 1 when `body` throws or what was printed cannot be written; 2 for
///     flags that cannot be understood, and when `body` throws UsageError; 3 when `body` throws
///     DemandNotMet.
int RunTool(CLI::App* app, int argc, const char* const* argv, const std::function<void()>& body);

}  // namespace voqcal
