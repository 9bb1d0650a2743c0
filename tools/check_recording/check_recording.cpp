// check_recording: what LCM logs hold, channel by channel, and what of the sensors' frames they
// lack.

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "check_recording/recording_contents.hpp"
#include "common/progress.hpp"
#include "common/tool_main.hpp"
#include "core/format.hpp"

namespace voqcal {
namespace {

struct CheckRecordingArgs {
  std::vector<std::filesystem::path> logs;
  bool is_quiet = false;
};

std::string NamesOf(const std::vector<std::filesystem::path>& logs) {
  std::string names;
  for (const std::filesystem::path& log : logs) {
    names += (names.empty() ? "" : ", ") + log.string();
  }
  return names;
}

RecordingContents Read(const std::vector<std::filesystem::path>& logs) {
  Progress progress("reading " + NamesOf(logs));
  const std::string num = std::to_string(logs.size()) + (logs.size() == 1 ? " log" : " logs");
  return ContentsOf(logs, [&](double share) { progress.Show(share, num); });
}

void PrintChannels(const RecordingContents& contents) {
  for (const auto& [name, channel] : contents.channels) {
    const auto rate_hz = channel.RateHz();
    std::printf("  %-32s %8lld %12s\n",
                name.c_str(),
                static_cast<long long>(channel.num_messages),
                rate_hz ? Format("%.1f Hz", *rate_hz).c_str() : "");
  }
}

[[noreturn]] void TellWhatFollows(const RecordingContents& contents) {
  std::string text =
      "the recording lacks what the modules may have seen: what is calibrated from it can differ "
      "from the live result";
  if (contents.NumLost() > 0) {
    text +=
        "; the computer or its disk was too slow for the sensors' rates, or net.core.rmem_max is "
        "too small (tools/symptoms.md, \"Messages lost\")";
  }
  throw DemandNotMet(text);
}

void CheckRecording(const CheckRecordingArgs& args) {
  const RecordingContents contents = Read(args.logs);
  const std::string missing = contents.Missing();
  if (contents.channels.empty()) throw DemandNotMet(NamesOf(args.logs) + ": holds no message");
  if (args.is_quiet && missing.empty()) return;
  std::printf("recording  %s: %.1f s, %.1f MB\n",
              NamesOf(args.logs).c_str(),
              static_cast<double>(contents.end_utime - contents.begin_utime) / 1e6,
              static_cast<double>(contents.num_bytes) / 1e6);
  if (!args.is_quiet) PrintChannels(contents);
  const std::string unknown = contents.Unknown();
  if (!unknown.empty()) {
    std::printf("unknown    %s: what was lost there does not show\n", unknown.c_str());
  }
  if (!missing.empty()) {
    std::printf("missing    %s\n", missing.c_str());
    TellWhatFollows(contents);
  }
  if (unknown.empty()) std::printf("missing    nothing of the images and sweeps\n");
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "What a recording holds, channel by channel, and how many of the sensors' images and sweeps "
      "it lacks, by their sequence numbers. Exit status 3: it lacks some.",
      "check_recording");
  voqcal::CheckRecordingArgs args;
  app.add_option("logs",
                 args.logs,
                 "The recording (LCM log); of a recorder that was started again its logs in order")
      ->required();
  app.add_flag("--quiet", args.is_quiet, "Only what it lacks; nothing if it is whole");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::CheckRecording(args); });
}
