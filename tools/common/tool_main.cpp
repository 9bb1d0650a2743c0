#include "common/tool_main.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "messaging/process.hpp"

namespace voqcal {
namespace {

// What was printed may be lost only now: into a file on a full disk, say.
void FlushOutput() {
  if (std::cout.flush() && std::fflush(stdout) == 0) return;
  throw std::runtime_error(std::string("standard output: cannot be written: ") +
                           std::strerror(errno));
}

}  // namespace

int RunTool(CLI::App* app, int argc, const char* const* argv, const std::function<void()>& body) {
  constexpr int kUsageError = 2;
  app->set_version_flag("--version", VOQCAL_VERSION);
  try {
    app->parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app->exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    PrintError(app->get_name(), error.what() + std::string(" (--help lists the flags)"));
    return kUsageError;
  }
  LogToStderr(app->get_name(), false);
  try {
    body();
    FlushOutput();
  } catch (const std::exception& error) {
    PrintError(app->get_name(), error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

}  // namespace voqcal
