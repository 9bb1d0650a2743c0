#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace voqcal {

/// The frame of every tool's main(): reads the flags that `app` has (and --version), runs `body`,
/// and prints its exception (PrintError).
///
/// @return the exit status: 0; 1 when `body` throws or what was printed cannot be written; 2 for
///     flags that cannot be understood.
int RunTool(CLI::App* app, int argc, const char* const* argv, const std::function<void()>& body);

}  // namespace voqcal
