// report: the report of a session that was calibrated live.

#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "calibrate/collect.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "messaging/session_scenes.hpp"
#include "report/no_result.hpp"
#include "report/write_report.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct ReportArgs {
  std::filesystem::path session;
  std::filesystem::path rig;
};

/// @throws std::runtime_error that says so, and where what was seen instead is.
[[noreturn]] void TellNoResult(const Rig& rig,
                               const std::filesystem::path& session,
                               const std::string& problem,
                               const std::vector<BoardSample>& samples) {
  const std::string why = (session / kSamplesLogName).string() + ": no calibration: " + problem;
  const std::string page_problem = WriteNoResult(rig, why, samples, session, session);
  throw std::runtime_error(why + (page_problem.empty()
                                      ? "\nwhat was seen: " + (session / kNoResultName).string()
                                      : "\nno page of what was seen: " + page_problem));
}

// A result depends on samples and rig only: what the live modules found is found again, on a copy.
void Report(const ReportArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const ScratchFolder scratch(args.session / "report");
  InputPaths input;
  input.log = args.session / kSamplesLogName;
  std::error_code unreadable;  // is said by who reads it
  if (std::filesystem::is_empty(*input.log, unreadable)) {
    TellNoResult(rig, args.session, "no sample was taken", {});
  }
  const auto run = CollectSamples(rig, input, scratch.path());
  run->Finish(/*is_collecting_only=*/false);
  if (!run->assessor().result()) {
    TellNoResult(rig, args.session, run->assessor().problem(), run->samples());
  }
  std::filesystem::remove(args.session / kNoResultName);
  const std::string problem = WriteReport(rig, *run, scratch.path());
  if (!problem.empty()) throw std::runtime_error(problem);
  std::cout << "written\n";
  for (const char* name : {kResultJsonName, kReportName}) {
    std::filesystem::rename(scratch.path() / name, args.session / name);
    std::cout << "  " << (args.session / name).string() << '\n';
  }
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Writes report.html and result.json of a session's samples, as calibrate does.",
               "report");
  voqcal::ReportArgs args;
  app.add_option("session", args.session, "The session's folder, with samples.lcm")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--rig", args.rig, "The rig file (YAML)")->required();
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::Report(args); });
}
