#include "messaging/process.hpp"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <sstream>

#include <CLI/CLI.hpp>
#include <malloc.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace voqcal {
namespace {

constexpr int kExitUsage = 2;

void AddFlags(CLI::App* app, ProcessArgs* args) {
  app->add_option("--rig", args->rig_path, "Rig file (YAML): board, sensors, channels, options")
      ->required()
      ->type_name("FILE");
  app->add_option("--lcm-url", args->lcm_url, "LCM network, instead of the rig file's")
      ->type_name("URL");
  app->add_option("--session", args->session_dir, "Session folder, for modules that keep files")
      ->type_name("DIR");
  app->add_option("--name",
                  args->name,
                  "What it is called in MODULE_STATUS and its log, where several of it run")
      ->type_name("NAME");
  app->add_flag("--verbose", args->is_verbose, "Log more");
  app->set_version_flag("--version", VOQCAL_VERSION);
}

// Sweeps and images are blocks of megabytes, many times a second. By default malloc returns each to
// the kernel and gets it again, whose zeroing of pages was a third of a large rig's work.
void KeepFreedMemory() {
  constexpr int kLargestBlockBytes = 32 << 20;  // the most that M_MMAP_THRESHOLD may be
  mallopt(M_MMAP_THRESHOLD, kLargestBlockBytes);
  mallopt(M_TRIM_THRESHOLD, 2 * kLargestBlockBytes);
}

}  // namespace

int RunProcess(int argc,
               const char* const* argv,
               const ProcessInfo& info,
               const std::function<void(const ProcessArgs&)>& body) {
  CLI::App app(info.description, info.name);
  ProcessArgs args;
  AddFlags(&app, &args);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    PrintError(info.name, error.what() + std::string(" (see --help)"));
    return kExitUsage;
  }
  KeepFreedMemory();
  try {
    LogToStderr(args.name.value_or(info.name), args.is_verbose);
    body(args);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    PrintError(info.name, error.what());
    return EXIT_FAILURE;
  }
}

void LogToStderr(const std::string& program, bool is_verbose) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  auto logger = std::make_shared<spdlog::logger>(program, std::move(sink));
  logger->set_pattern("[%H:%M:%S.%e] %n: %^%l%$: %v");
  logger->set_level(is_verbose ? spdlog::level::debug : spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
}

void PrintError(const std::string& program, const std::string& text) {
  bool is_told = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (line.empty()) continue;
    std::cerr << program << ": " << line << '\n';
    is_told = true;
  }
  if (!is_told) std::cerr << program << ": failed, without a reason\n";
}

}  // namespace voqcal
