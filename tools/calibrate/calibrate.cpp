// calibrate: the main job on a recording, or on features that another program extracted.

#include <filesystem>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

#include <spdlog/spdlog.h>

#include "calibrate/bag.hpp"
#include "calibrate/collect.hpp"
#include "calibrate/finish_session.hpp"
#include "calibrate/plate_of_recording.hpp"
#include "calibrate/summary.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "files/atomic_file.hpp"
#include "messaging/log.hpp"
#include "report/write_report.hpp"
#include "result/result_file.hpp"
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

void Print(const CalibrateArgs& args, const OfflineRun& run) {
  if (args.is_json) {
    std::cout << ReadWholeFile(args.out / kResultJsonName);
    return;
  }
  std::cout << Summary(*run.assessor().result()) << "frames\n  " << CountsOf(run) << "\nwritten\n  "
            << (args.out / kResultName).string() << "\n  " << (args.out / kSamplesLogName).string()
            << "\n  " << (args.out / kResultJsonName).string() << '\n';
  if (std::filesystem::exists(args.out / kReportName))
    std::cout << "  " << (args.out / kReportName).string() << '\n';
}

void RunCalibrate(const CalibrateArgs& args) {
  Rig rig = LoadRig(args.rig, PlateInRig::kMayBeMissing);
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
  if (!rig.is_plate_given) MeasurePlate(input, scratch.path(), &rig);
  const auto run = CollectSamples(rig, input, scratch.path());
  FinishSession(rig, Given(args), {scratch.path(), args.out}, run.get());
  Print(args, *run);
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
