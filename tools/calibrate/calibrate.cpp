// calibrate: the main job on a recording, or on features that another program extracted.

#include <filesystem>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

#include <spdlog/spdlog.h>
#include <system_error>

#include "calibrate/advice.hpp"
#include "calibrate/bag.hpp"
#include "calibrate/collect.hpp"
#include "calibrate/summary.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "core/selection/offset_sign.hpp"
#include "files/atomic_file.hpp"
#include "messaging/log.hpp"
#include "report/no_result.hpp"
#include "report/write_report.hpp"
#include "rig/rig.hpp"
#include "rig/rig_doubts.hpp"

namespace voqcal {
namespace {

struct CalibrateArgs {
  std::filesystem::path rig;
  InputPaths input;
  BagInput bag;  // instead of input.log
  std::filesystem::path out;
  bool is_json = false;
  std::string demand;  ///< "usable" or "good"; empty: none.
};

std::string Given(const CalibrateArgs& args) {
  return args.bag.paths.empty() ? args.input.Given().string() : args.bag.paths.front();
}

// Moves the finished files to where they were asked for, the result last. A report that could not
// be made must not leave an earlier one beside a new result.
void Deliver(const std::filesystem::path& from, const std::filesystem::path& to) {
  RequireNotBeingWritten(to / kSamplesLogName);
  std::error_code error;
  std::filesystem::create_directories(to, error);
  if (!std::filesystem::exists(from / kReportName))
    std::filesystem::remove(to / kReportName, error);
  std::filesystem::remove(to / kNoResultName, error);
  for (const char* name : {kReportName, kSamplesLogName, kResultJsonName, kResultName}) {
    if (error || !std::filesystem::exists(from / name)) continue;
    std::filesystem::rename(from / name, to / name, error);
  }
  if (error) throw std::runtime_error(to.string() + ": cannot write: " + error.message());
}

// Says so if a result is there that is not the one just asked for.
std::string EarlierResultIn(const std::filesystem::path& folder) {
  const std::filesystem::path result = folder / kResultName;
  return std::filesystem::exists(result) ? "; " + result.string() + " is of an earlier run" : "";
}

/// Makes a page of what was seen, where there is no result. @return where it is, as a line.
std::string SeenInstead(const Rig& rig,
                        const OfflineRun& run,
                        const std::string& problem,
                        const std::filesystem::path& session,
                        const std::filesystem::path& out) {
  const std::string page_problem = WriteNoResult(rig, problem, run.samples(), session, out);
  return page_problem.empty() ? "\nwhat was seen: " + (out / kNoResultName).string()
                              : "\nno page of what was seen: " + page_problem;
}

void Print(const CalibrateArgs& args, const OfflineRun& run, bool has_report) {
  if (args.is_json) {
    std::cout << ReadWholeFile(args.out / kResultJsonName);
    return;
  }
  std::cout << Summary(*run.assessor().result()) << "frames\n  " << CountsOf(run) << "\nwritten\n  "
            << (args.out / kResultName).string() << "\n  " << (args.out / kSamplesLogName).string()
            << "\n  " << (args.out / kResultJsonName).string() << '\n';
  if (has_report) std::cout << "  " << (args.out / kReportName).string() << '\n';
}

/// @throws DemandNotMet unless the verdict is as good as was demanded.
void RequireVerdict(const Verdict& verdict, const std::string& demand) {
  if (demand.empty()) return;
  const Grade least = demand == "good" ? Grade::kGood : Grade::kLook;
  if (verdict.grade <= least) return;
  throw DemandNotMet("the result is not " + demand + ", as --require demands: " + verdict.headline);
}

void RunCalibrate(const CalibrateArgs& args) {
  const Rig rig = LoadRig(args.rig);
  for (const std::string& doubt : BoardDoubts(rig.board)) spdlog::warn("{}", doubt);
  for (const std::string& doubt : CameraDoubts(rig.camera)) spdlog::warn("{}", doubt);
  if (std::filesystem::exists(args.out) && !std::filesystem::is_directory(args.out)) {
    throw std::runtime_error(args.out.string() + ": is in the way: --out names a folder");
  }
  RequireNotBeingWritten(args.out /
                         kSamplesLogName);  // a live session's, which must not be replaced
  const ScratchFolder scratch(args.out);
  InputPaths input = args.input;
  if (!args.bag.paths.empty()) {
    input.log = ImportBag(rig, args.bag, input.times, scratch.path());
    input.times = RecordingTimes::kStamps;  // the import has settled them
  }
  const auto run = CollectSamples(rig, input, scratch.path());
  run->Finish(/*is_collecting_only=*/false);
  const std::string wrong_sign = WrongOffsetSign(run->samples(), rig.board);
  if (!run->assessor().result()) {
    const std::string why = Given(args) + ": no calibration: " + run->assessor().problem();
    const std::string advice = FailureAdvice(*run) + (wrong_sign.empty() ? "" : "\n" + wrong_sign);
    throw std::runtime_error(why + " (" + CountsOf(*run) + ")" + EarlierResultIn(args.out) +
                             advice +
                             SeenInstead(rig, *run, why + advice, scratch.path(), args.out));
  }
  const std::string report_problem = WriteReport(rig, *run, scratch.path());
  Deliver(scratch.path(), args.out);
  if (!wrong_sign.empty()) spdlog::warn("{}: {}", rig.path.string(), wrong_sign);
  if (!report_problem.empty()) spdlog::warn("no {}: {}", kReportName, report_problem);
  Print(args, *run, report_problem.empty());
  RequireVerdict(VerdictOf(*run->assessor().result()), args.demand);
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  using voqcal::RecordingTimes;
  CLI::App app("Calibrates a camera against a lidar from a recording of both.", "calibrate");
  voqcal::CalibrateArgs args;
  app.add_option("--rig", args.rig, "The rig file (YAML): board, camera, channels, options")
      ->required();
  auto* input = app.add_option_group("input", "One of:");
  input->add_option("--log", args.input.log, "A recording (LCM log), or a session's samples.lcm");
  input->add_option(
      "--poses", args.input.poses, "Extracted features: poses.csv of cam_lidar_calibration");
  auto* bag =
      input->add_option("--bag",
                        args.bag.paths,
                        "A recording of ROS 1 or 2: .bag, .mcap, .db3, their folder; several "
                        "files if it is split. Or an LCM log of a lidar's packets or of types of "
                        "your own");
  input->require_option(1);
  app.add_option("--lidar-topic", args.bag.lidar_topic, "Of --bag, unless there is only one")
      ->needs(bag);
  app.add_option("--image-topic", args.bag.image_topic, "Of --bag, unless there is only one")
      ->needs(bag);
  const std::map<std::string, RecordingTimes> times = {{"auto", RecordingTimes::kAuto},
                                                       {"stamps", RecordingTimes::kStamps},
                                                       {"log", RecordingTimes::kLog}};
  app.add_option_function<std::string>(
         "--times",
         [&](const std::string& name) { args.input.times = times.at(name); },
         "Of a recording: a message's time is its stamp, or when it was recorded (log); auto, "
         "unless told, takes stamps unless they are of different clocks")
      ->check(CLI::IsMember({"auto", "stamps", "log"}));
  app.add_option(
         "--out",
         args.out,
         "Folder for extrinsic.yaml, result.json, report.html and samples.lcm; made if missing")
      ->required();
  app.add_flag("--json", args.is_json, "Print result.json instead of a summary");
  app.add_option("--require",
                 args.demand,
                 "End with exit status 3 unless the verdict is at least this: usable or good")
      ->check(CLI::IsMember({"usable", "good"}));
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::RunCalibrate(args); });
}
