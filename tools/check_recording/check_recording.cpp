// check_recording: what an LCM log holds, channel by channel, and what of the sensors' frames it
// lacks.

#include <cstdio>
#include <filesystem>
#include <string>

#include "check_recording/recording_contents.hpp"
#include "common/tool_main.hpp"
#include "core/format.hpp"

namespace voqcal {
namespace {

struct CheckRecordingArgs {
  std::filesystem::path log;
  bool is_quiet = false;
};

void PrintChannels(const RecordingContents& contents) {
  for (const auto& [name, channel] : contents.channels) {
    const auto rate_hz = channel.RateHz();
    std::printf("  %-32s %8lld %12s\n",
                name.c_str(),
                static_cast<long long>(channel.num_messages),
                rate_hz ? Format("%.1f Hz", *rate_hz).c_str() : "");
  }
}

void CheckRecording(const CheckRecordingArgs& args) {
  const RecordingContents contents = ContentsOf(args.log);
  const std::string missing = contents.Missing();
  if (args.is_quiet && missing.empty()) return;
  std::printf("recording  %s: %.1f s, %.1f MB\n",
              args.log.c_str(),
              static_cast<double>(contents.end_utime - contents.begin_utime) / 1e6,
              static_cast<double>(contents.num_bytes) / 1e6);
  if (!args.is_quiet) PrintChannels(contents);
  if (missing.empty()) {
    std::printf("missing    nothing of the images and sweeps\n");
    return;
  }
  std::printf("missing    %s\n", missing.c_str());
  throw DemandNotMet(
      "the recording lacks what the modules may have seen: what is calibrated from it can differ "
      "from the live result. Either the computer or its disk is too slow for the sensors' rates, "
      "or net.core.rmem_max is too small (tools/symptoms.md, \"Messages lost\")");
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "What a recording holds, channel by channel, and how many of the sensors' images and sweeps "
      "it lacks, by their sequence numbers. Exit status 3: it lacks some.",
      "check_recording");
  voqcal::CheckRecordingArgs args;
  app.add_option("log", args.log, "The recording (LCM log)")->required();
  app.add_flag("--quiet", args.is_quiet, "Only what it lacks; nothing if it is whole");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::CheckRecording(args); });
}
