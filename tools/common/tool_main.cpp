#include "common/tool_main.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>

#include <malloc.h>

#include "messaging/process.hpp"

namespace voqcal {
namespace {

// What was printed may be lost only now: into a file on a full disk, say. Where it was lost before,
// glibc has forgotten it: only the streams' state tells, and no cause is known.
void FlushOutput() {
  errno = 0;
  std::cout.flush();
  const bool is_lost_now = std::fflush(stdout) != 0;
  if (!is_lost_now && std::cout && std::ferror(stdout) == 0) return;
  const std::string cause = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
  throw std::runtime_error("standard output: cannot be written" + cause);
}

constexpr int kUsageError = 2;
constexpr int kDemandNotMet = 3;

/// @return the exit status of `steps` and of what they print.
int StatusOf(const std::string& program, const std::function<void()>& steps) {
  try {
    steps();
    FlushOutput();
  } catch (const DemandNotMet& unmet) {
    PrintError(program, unmet.what());
    return kDemandNotMet;
  } catch (const UsageError& error) {
    PrintError(program, error.what() + std::string(" (--help lists the flags)"));
    return kUsageError;
  } catch (const std::exception& error) {
    PrintError(program, error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

// An image's memory is kept for the next one: to have the system clear it anew costs a tenth of a
// calibration.
void KeepFreedMemory() {
  constexpr int kLargestOfGlibc = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, kLargestOfGlibc);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

}  // namespace

int RunTool(CLI::App* app, int argc, const char* const* argv, const std::function<void()>& body) {
  app->set_version_flag("--version", VOQCAL_VERSION);
  try {
    app->parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return StatusOf(app->get_name(), [&] { app->exit(help_or_version); });
  } catch (const CLI::ParseError& error) {
    PrintError(app->get_name(), error.what() + std::string(" (--help lists the flags)"));
    return kUsageError;
  }
  LogToStderr(app->get_name(), false);
  KeepFreedMemory();
  return StatusOf(app->get_name(), body);
}

}  // namespace voqcal
