// status: what every module of a running rig says of itself, on one terminal page.

#include "messaging/status.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/tool_main.hpp"
#include "messaging/bus.hpp"
#include "messaging/spin.hpp"
#include "rig/rig.hpp"
#include "rig_status/status_page.hpp"

namespace voqcal {
namespace {

using Clock = std::chrono::steady_clock;

struct StatusArgs {
  std::filesystem::path rig;
  std::optional<std::string> lcm_url;
  std::vector<std::string> modules = AllModuleNames();
  std::vector<std::string> ended;
  bool is_once = false;
  std::optional<std::filesystem::path> alone_in;
};

/// A heartbeat of each module, with room to spare.
constexpr std::chrono::milliseconds kProbeDuration{1500};
/// Two heartbeats of each module: rates of sending need both.
constexpr std::chrono::milliseconds kOnceDuration{2500};

void Subscribe(const Channels& channels, Bus* bus, StatusPage* page) {
  bus->Subscribe<module_status_t>(
      channels.module_status, Queue::kEvery, [page](const module_status_t& m) {
        page->Take(m, Clock::now());
      });
  bus->Subscribe<event_t>(
      channels.calib_event, Queue::kEvery, [page](const event_t& m) { page->Take(m); });
}

void PrintOnce(const StatusArgs& args, Bus* bus, StatusPage* page) {
  const Clock::time_point end = Clock::now() + kOnceDuration;
  while (Clock::now() < end) bus->HandleOnce(std::chrono::milliseconds(100));
  std::fputs(page->Text(Clock::now()).c_str(), stdout);
  if (!page->IsAllGood(Clock::now())) {
    throw std::runtime_error(args.rig.string() + ": not every module is well");
  }
}

/// Fails if another session runs any of the modules on this network.
void RequireAlone(const StatusArgs& args, const std::string& url, Bus* bus, StatusPage* page) {
  const Clock::time_point end = Clock::now() + kProbeDuration;
  while (Clock::now() < end) bus->HandleOnce(std::chrono::milliseconds(100));
  std::string problems;
  for (const std::string& rival : page->Rivals(Clock::now(), SessionName(*args.alone_in))) {
    const std::string module = rival.substr(0, rival.find(' '));
    const auto& ours = args.modules;
    if (std::find(ours.begin(), ours.end(), module) == ours.end()) continue;
    problems += url + ": " + rival + '\n';
  }
  if (problems.empty()) return;
  throw std::runtime_error(
      problems +
      "two sessions would mix their samples: stop the other one (tools/down), or give this rig "
      "another port in lcm.url");
}

/// Until Ctrl-C.
void PrintEachSecond(Bus* bus, StatusPage* page) {
  const StopOnSignal stop;
  Clock::time_point next = Clock::now() + std::chrono::seconds(1);
  while (!stop.IsRequested()) {
    bus->HandleOnce(std::chrono::milliseconds(100));
    if (Clock::now() < next) continue;
    next += std::chrono::seconds(1);
    // Cursor to the top left, clear the page.
    std::printf("\033[H\033[J%s", page->Text(Clock::now()).c_str());
    std::fflush(stdout);
  }
}

void ShowStatus(const StatusArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const std::string url = args.lcm_url.value_or(rig.lcm_url);
  Bus bus(url);
  StatusPage page(args.modules, args.ended);
  Subscribe(rig.channels, &bus, &page);
  if (args.alone_in) {
    RequireAlone(args, url, &bus, &page);
  } else if (args.is_once) {
    PrintOnce(args, &bus, &page);
  } else {
    PrintEachSecond(&bus, &page);
  }
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Shows every module of a running rig: state, rates, losses, results and misses by reason.",
      "status");
  voqcal::StatusArgs args;
  app.add_option("rig", args.rig, "The rig file (YAML)")->required();
  app.add_option("--lcm-url", args.lcm_url, "Instead of the rig file's");
  app.add_option("--modules", args.modules, "Those that should be heard; without it all")
      ->delimiter(',')
      ->check(CLI::IsMember(voqcal::AllModuleNames()));
  app.add_option("--ended", args.ended, "Those that are known to have ended as planned")
      ->delimiter(',')
      ->check(CLI::IsMember(voqcal::AllModuleNames()));
  app.add_flag("--once",
               args.is_once,
               "Listen for 2.5 s, print one page; status 1 if a module is silent, has failed or is "
               "run by two sessions, or if messages were lost");
  app.add_option("--alone-in",
                 args.alone_in,
                 "Listen for 1.5 s, print nothing; status 1 and who it is if a session other than "
                 "this folder's runs any of the modules");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::ShowStatus(args); });
}
