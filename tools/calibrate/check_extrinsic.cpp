// check_extrinsic: is an extrinsic still right? By any recording's scenes, without a board.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "calibrate/lens_of_result.hpp"
#include "common/tool_main.hpp"
#include "core/scene/scene_check.hpp"
#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "files/transform_yaml.hpp"
#include "messaging/bus.hpp"
#include "messaging/log.hpp"
#include "messaging/scene_window.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {
namespace {

constexpr int kExitDisagrees = 3;
constexpr int kExitCannotTell = 4;

struct CheckArgs {
  std::filesystem::path rig;
  std::filesystem::path log;
  std::filesystem::path extrinsic;
  std::optional<std::filesystem::path> refine;
  std::optional<double> max_apart_ms;
  std::optional<double> every_s;
  int max_scenes = 60;
};

template <typename Message>
void AddTo(const LogEvent& event, SceneWindow* window) {
  Message message{};
  if (DecodeMessage(event.bytes.data(), event.bytes.size(), &message).empty()) window->Add(message);
}

std::vector<SceneView> ViewsOf(const Rig& rig, const CheckArgs& args) {
  SceneWindowOptions options = rig.extrinsic_monitor.window;
  if (args.max_apart_ms) options.max_apart_s = 1e-3 * *args.max_apart_ms;
  if (args.every_s) options.every_s = *args.every_s;
  std::map<std::string, int> unusable;
  SceneWindow window(
      rig.camera, rig.scene_check.view, options, [&unusable](const std::string& reason) {
        ++unusable[reason];
      });
  LogReader reader(args.log);
  try {
    while (const std::optional<LogEvent> event = reader.Next()) {
      if (event->channel == rig.channels.lidar_points) AddTo<pointcloud2_t>(*event, &window);
      if (event->channel == rig.channels.camera_image) AddTo<image_t>(*event, &window);
      if (static_cast<int>(window.views().size()) >= args.max_scenes) break;
    }
  } catch (const TruncatedLogError&) {  // what came before the cut is good
  }
  if (static_cast<int>(window.views().size()) < args.max_scenes) window.Finish();
  for (const auto& [reason, count] : unusable) {
    std::fprintf(stderr, "check_extrinsic: %d pairs make no scene: %s\n", count, reason.c_str());
  }
  if (window.views().empty() && !unusable.empty()) {
    throw std::runtime_error(args.log.string() + ": no pair makes a scene (the cause is above)");
  }
  if (window.views().empty()) {
    throw std::runtime_error(
        args.log.string() + ": no usable sweep on " + rig.channels.lidar_points +
        " with an image on " + rig.channels.camera_image + " within " +
        std::to_string(std::lround(1e3 * options.max_apart_s)) + " ms (see --max-apart-ms)");
  }
  return window.views();
}

void Print(const SceneCheck& check) {
  const char* const names[] = {"turn about x",
                               "turn about y",
                               "turn about z",
                               "shift along x",
                               "shift along y",
                               "shift along z"};
  std::printf("%d scenes, %d depth edges in the images; camera axes: x right, y down, z forward\n",
              check.num_scenes,
              check.num_edges);
  if (!check.sigma.allFinite()) {  // no axis has a number
    std::printf("the extrinsic: %s: %s\n", ToString(check.verdict).c_str(), check.reason.c_str());
    return;
  }
  for (int i = 0; i < 6; ++i) {
    const double unit = i < 3 ? kDegPerRad : 1e3;
    std::printf("%-13s  %8.2f +- %5.2f %s  %s\n",
                names[i],
                unit * check.asked[i],
                unit * check.sigma[i],
                i < 3 ? "deg" : "mm ",
                ToString(check.axes[static_cast<std::size_t>(i)]).c_str());
  }
  std::printf("the extrinsic: %s\n", ToString(check.verdict).c_str());
}

int Check(const CheckArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const Eigen::Isometry3d T_camera_lidar = ReadExtrinsic(args.extrinsic);
  const std::string lens_doubt = LensDoubt(args.extrinsic, rig.camera);
  if (!lens_doubt.empty()) spdlog::warn("{}", lens_doubt);
  const SceneCheck check =
      CheckScene(ViewsOf(rig, args), rig.camera, T_camera_lidar, rig.scene_check);
  Print(check);
  if (args.refine && check.verdict == Agreement::kCannotTell) {
    std::printf("%s is not written: the scenes cannot tell\n", args.refine->c_str());
  } else if (args.refine) {
    WriteFileAtomically(*args.refine,
                        "T_camera_lidar:  # refined by scenes alone\n" +
                            TransformYaml(PerturbLeft(T_camera_lidar, check.asked), "  "));
    std::printf("written\n  %s\n", args.refine->c_str());
  }
  if (check.verdict == Agreement::kDisagrees) return kExitDisagrees;
  return check.verdict == Agreement::kAgrees ? EXIT_SUCCESS : kExitCannotTell;
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Says whether an extrinsic still fits what lidar and camera see, without any board.\n"
      "Exit status: 0 agrees, 3 disagrees, 4 cannot tell; 1 and 2: errors.",
      "check_extrinsic");
  voqcal::CheckArgs args;
  app.add_option("--rig", args.rig, "The rig file (YAML): camera and channels")->required();
  app.add_option("--log", args.log, "Any recording of both sensors (LCM log)")->required();
  app.add_option("--extrinsic",
                 args.extrinsic,
                 "A result's folder or its extrinsic.yaml, or any YAML with T_camera_lidar")
      ->required();
  app.add_option("--refine", args.refine, "Write the extrinsic that the scenes ask for (YAML)");
  app.add_option(
         "--max-apart-ms",
         args.max_apart_ms,
         "Between a sweep and its image; default: as extrinsic_monitor in the rig file says")
      ->check(CLI::PositiveNumber);
  app.add_option("--every-s", args.every_s, "At least so long between two scenes; the same")
      ->check(CLI::PositiveNumber);
  app.add_option("--max-scenes", args.max_scenes, "No more than so many")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  int verdict = EXIT_SUCCESS;
  const int status = voqcal::RunTool(&app, argc, argv, [&] { verdict = voqcal::Check(args); });
  return status != EXIT_SUCCESS ? status : verdict;
}
