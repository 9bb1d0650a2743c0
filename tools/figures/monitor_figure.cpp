// How often scenes disagree with an extrinsic that is right, and how often they find a knock:
// windows of simulated drives.

#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "core/scene/scene_check.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/simulation.hpp"
#include "core/units.hpp"
#include "figures/figures.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct MonitorArgs {
  std::filesystem::path rig;
  int num_halls = 40;
  int num_windows = 100;
  int num_scenes = 30;  // a window of 30 s has as many
  double knock_deg = 0.2;
  std::uint32_t seed = 1;
};

constexpr int kScenesOfAHall = 3;

// Halls with other people and furniture in each, from where the rig stands in them.
std::vector<SceneView> ViewsOfHalls(const Rig& rig, const MonitorArgs& args) {
  std::vector<SceneView> views;
  for (int hall = 0; hall < args.num_halls; ++hall) {
    SimulationOptions options = rig.simulation;
    options.seed = args.seed + static_cast<std::uint32_t>(hall);
    options.has_clutter = true;
    options.num_poses = kScenesOfAHall;
    const Simulation simulation(options, rig.board, rig.camera);
    for (int i = 0; i < kScenesOfAHall; ++i) {
      const double time_s = i * (options.hold_s + options.move_s) + options.hold_s / 2;
      views.push_back(MakeSceneView(
          simulation.Sweep(time_s), simulation.Image(time_s), rig.camera, rig.scene_check.view));
    }
  }
  return views;
}

using Tally = std::array<int, 3>;  // by Agreement

void PrintRow(const char* what, const Tally& tally) {
  std::printf("%-22s  %5d  %9d  %11d\n",
              what,
              tally[static_cast<std::size_t>(Agreement::kAgrees)],
              tally[static_cast<std::size_t>(Agreement::kDisagrees)],
              tally[static_cast<std::size_t>(Agreement::kCannotTell)]);
}

void PrintMonitor(const MonitorArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const std::vector<SceneView> halls = ViewsOfHalls(rig, args);
  Tally right{};
  std::array<Tally, 3> knocked{};
  for (int window = 0; window < args.num_windows; ++window) {
    const KeyedNoise noise(args.seed, NoiseUse::kStopOrder, window);
    std::vector<SceneView> views;
    for (int i = 0; i < args.num_scenes; ++i) {
      views.push_back(halls[noise.Bits(static_cast<std::uint64_t>(i)) % halls.size()]);
    }
    const auto verdict_of = [&](const Eigen::Isometry3d& T_camera_lidar) {
      return static_cast<std::size_t>(
          CheckScene(views, rig.camera, T_camera_lidar, rig.scene_check).verdict);
    };
    ++right[verdict_of(rig.simulation.T_camera_lidar)];
    const int axis = window % 3;
    Vector6d knock = Vector6d::Zero();
    knock[axis] = (window % 2 == 0 ? 1 : -1) * args.knock_deg * kRadPerDeg;
    ++knocked[static_cast<std::size_t>(axis)]
             [verdict_of(PerturbLeft(rig.simulation.T_camera_lidar, knock))];
  }
  std::printf(
      "%d windows of %d scenes, of %d halls\n", args.num_windows, args.num_scenes, args.num_halls);
  std::puts("extrinsic               agrees  disagrees  cannot tell");
  PrintRow("the truth", right);
  const char* const names[] = {"turned about x", "turned about y", "turned about z"};
  for (std::size_t axis = 0; axis < 3; ++axis) PrintRow(names[axis], knocked[axis]);
  std::printf("asked: the truth disagrees in 1 of 1000; turned by %.1f deg disagrees in 95 %%\n",
              args.knock_deg);
}

}  // namespace

void AddMonitor(CLI::App* app) {
  CLI::App* figure = app->add_subcommand(
      "monitor", "Scenes without a board: false alarms, and knocks that are found");
  auto args = std::make_shared<MonitorArgs>();
  figure->add_option("--rig", args->rig, "The rig file, of a simulated rig")->required();
  figure->add_option("--halls", args->num_halls, "That the windows are drawn from")
      ->capture_default_str();
  figure->add_option("--windows", args->num_windows)->capture_default_str();
  figure->add_option("--scenes", args->num_scenes, "Of a window")->capture_default_str();
  figure->add_option("--knock-deg", args->knock_deg)->capture_default_str();
  figure->add_option("--seed", args->seed)->capture_default_str();
  figure->callback([args] { PrintMonitor(*args); });
}

}  // namespace voqcal
