#include "common/tool_main.hpp"

#include <cstdlib>
#include <exception>
#include <iostream>

#include "messaging/process.hpp"

namespace voqcal {

int RunTool(CLI::App* app, int argc, const char* const* argv, const std::function<void()>& body) {
  constexpr int kUsageError = 2;
  app->set_version_flag("--version", VOQCAL_VERSION);
  try {
    app->parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app->exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    std::cerr << app->get_name() << ": " << OneLine(error.what()) << " (--help lists the flags)\n";
    return kUsageError;
  }
  LogToStderr(app->get_name(), false);
  try {
    body();
  } catch (const std::exception& error) {
    std::cerr << app->get_name() << ": " << OneLine(error.what()) << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

}  // namespace voqcal
