// check_extrinsic: is an extrinsic still right? By any recording's scenes, without a board.

#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/tool_main.hpp"
#include "core/scene/scene_agreement.hpp"
#include "core/units.hpp"
#include "files/atomic_file.hpp"
#include "files/transform_yaml.hpp"
#include "messaging/bus.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/log.hpp"
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
  double max_apart_ms = 60;
  double every_s = 0.9;
  int max_scenes = 60;
};

template <typename Message>
std::optional<Message> Decode(const LogEvent& event) {
  Message message{};
  if (!DecodeMessage(event.bytes.data(), event.bytes.size(), &message).empty()) return {};
  return message;
}

// Sweeps with an image of about the same time, not all of a second's.
class SceneCollector {
 public:
  SceneCollector(const Rig& rig, const CheckArgs& args) : rig_(rig), args_(args) {}

  bool IsFull() const { return static_cast<int>(views_.size()) >= args_.max_scenes; }
  const std::vector<SceneView>& views() const { return views_; }

  void Add(const LogEvent& event) {
    if (event.channel == rig_.channels.lidar_points) Keep(Decode<pointcloud2_t>(event), &sweeps_);
    if (event.channel == rig_.channels.camera_image) Keep(Decode<image_t>(event), &images_);
    for (const pointcloud2_t& sweep : sweeps_) {
      for (const image_t& image : images_) {
        if (AddPair(sweep, image)) return;
      }
    }
  }

 private:
  // Either sensor's messages may come late by some of the other's.
  template <typename Message>
  static void Keep(std::optional<Message> message, std::deque<Message>* kept) {
    constexpr std::size_t kNumKept = 5;
    if (!message) return;
    kept->push_back(std::move(*message));
    if (kept->size() > kNumKept) kept->pop_front();
  }

  bool AddPair(const pointcloud2_t& sweep, const image_t& image) {
    const double apart_us = static_cast<double>(std::abs(sweep.utime - image.utime));
    if (apart_us > 1e3 * args_.max_apart_ms) return false;
    if (last_utime_ && static_cast<double>(sweep.utime - *last_utime_) < 1e6 * args_.every_s) {
      return false;
    }
    last_utime_ = sweep.utime;
    views_.push_back(
        MakeSceneView(FromMessage(sweep), FromMessage(image), rig_.camera, rig_.scene_check.view));
    return true;
  }

  const Rig& rig_;
  const CheckArgs& args_;
  std::deque<pointcloud2_t> sweeps_;
  std::deque<image_t> images_;
  std::optional<std::int64_t> last_utime_;
  std::vector<SceneView> views_;
};

std::vector<SceneView> ViewsOf(const Rig& rig, const CheckArgs& args) {
  SceneCollector collector(rig, args);
  LogReader reader(args.log);
  try {
    while (const std::optional<LogEvent> event = reader.Next()) {
      collector.Add(*event);
      if (collector.IsFull()) break;
    }
  } catch (const TruncatedLogError&) {  // what came before the cut is good
  }
  if (collector.views().empty()) {
    throw std::runtime_error(args.log.string() + ": no sweep on " + rig.channels.lidar_points +
                             " with an image on " + rig.channels.camera_image + " within " +
                             std::to_string(static_cast<int>(args.max_apart_ms)) +
                             " ms (see --max-apart-ms)");
  }
  return collector.views();
}

void Print(const SceneAgreement& agreement) {
  const char* const names[] = {"turn about x",
                               "turn about y",
                               "turn about z",
                               "shift along x",
                               "shift along y",
                               "shift along z"};
  std::printf("%d scenes, %d depth edges in the images; camera axes: x right, y down, z forward\n",
              agreement.refinement.num_scenes,
              agreement.refinement.num_edges);
  for (int i = 0; i < 6; ++i) {
    const double unit = i < 3 ? kDegPerRad : 1e3;
    std::printf("%-13s  %8.2f +- %5.2f %s  %s\n",
                names[i],
                unit * agreement.asked[i],
                unit * agreement.sigma[i],
                i < 3 ? "deg" : "mm ",
                ToString(agreement.axes[static_cast<std::size_t>(i)]).c_str());
  }
  std::printf("the extrinsic: %s\n", ToString(agreement.all).c_str());
}

int Check(const CheckArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const Eigen::Isometry3d T_camera_lidar = ReadExtrinsic(args.extrinsic);
  const SceneAgreement agreement =
      CheckAgreement(ViewsOf(rig, args), rig.camera, T_camera_lidar, {});
  Print(agreement);
  if (args.refine && agreement.all == Agreement::kCannotTell) {
    std::printf("%s is not written: the scenes cannot tell\n", args.refine->c_str());
  } else if (args.refine) {
    WriteFileAtomically(*args.refine,
                        "T_camera_lidar:  # refined by scenes alone\n" +
                            TransformYaml(PerturbLeft(T_camera_lidar, agreement.asked), "  "));
    std::printf("written\n  %s\n", args.refine->c_str());
  }
  if (agreement.all == Agreement::kDisagrees) return kExitDisagrees;
  return agreement.all == Agreement::kAgrees ? EXIT_SUCCESS : kExitCannotTell;
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
  app.add_option("--max-apart-ms", args.max_apart_ms, "Between a sweep and its image")
      ->capture_default_str();
  app.add_option("--every-s", args.every_s, "At least so long between two scenes")
      ->capture_default_str();
  app.add_option("--max-scenes", args.max_scenes, "No more than so many")->capture_default_str();
  int verdict = EXIT_SUCCESS;
  const int status = voqcal::RunTool(&app, argc, argv, [&] { verdict = voqcal::Check(args); });
  return status != EXIT_SUCCESS ? status : verdict;
}
