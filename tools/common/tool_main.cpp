#include "common/tool_main.hpp"

#include <cstdlib>
#include <exception>
#include <string>

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
    PrintError(app->get_name(), error.what() + std::string(" (--help lists the flags)"));
    return kUsageError;
  }
  LogToStderr(app->get_name(), false);
  try {
    body();
  } catch (const std::exception& error) {
    PrintError(app->get_name(), error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

}  // namespace voqcal
