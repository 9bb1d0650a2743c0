// command: tells the sample collector what to do.

#include <chrono>
#include <optional>
#include <string>

#include "common/tool_main.hpp"
#include "messaging/bus.hpp"
#include "rig/rig.hpp"
#include "voqcal/command_t.hpp"

namespace voqcal {
namespace {

struct CommandArgs {
  std::filesystem::path rig;
  std::optional<std::string> lcm_url;
  std::string command;
  std::int64_t sample_id = 0;
};

void Send(const CommandArgs& args) {
  const Rig rig = LoadRig(args.rig);
  Bus bus(args.lcm_url.value_or(rig.lcm_url));
  command_t message{};
  message.utime = std::chrono::duration_cast<std::chrono::microseconds>(
                      std::chrono::system_clock::now().time_since_epoch())
                      .count();
  message.command = args.command;
  message.sample_id = args.sample_id;
  bus.Publish(rig.channels.calib_command, message);
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Sends one command to the sample collector.", "command");
  voqcal::CommandArgs args;
  app.add_option("command",
                 args.command,
                 "capture: take the next pair of frames; discard: take a sample away; finish: no "
                 "more will come; reset: take all samples away")
      ->required()
      ->check(CLI::IsMember({"capture", "discard", "finish", "reset"}));
  app.add_option("--sample", args.sample_id, "Which sample to discard; without it the newest");
  app.add_option("--rig", args.rig, "The rig file (YAML)")->required();
  app.add_option("--lcm-url", args.lcm_url, "Instead of the rig file's");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Send(args); });
}
