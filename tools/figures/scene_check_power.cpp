// How large a turn of the extrinsic the scene check notices, and how often it disagrees with one
// that is right: on the scenes of a session, all of them or some drawn at random.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "core/scene/scene_check.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "core/units.hpp"
#include "figures/figures.hpp"
#include "messaging/session_views.hpp"
#include "result/result_file.hpp"
#include "rig/rig.hpp"
#include "sample_collector/session_log.hpp"

namespace voqcal {
namespace {

struct Args {
  std::filesystem::path rig;
  std::filesystem::path session;
  int num_scenes = 0;  // 0: all
  int num_draws = 1;
  std::uint32_t seed = 1;
};

// `num` of the views, as one draw orders them.
std::vector<SceneView> SomeOf(const std::vector<SceneView>& views, int num, KeyedNoise noise) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t i = 0; i < views.size(); ++i) order.emplace_back(noise.Bits(i), i);
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), static_cast<std::size_t>(num)));
  std::vector<SceneView> some;
  for (const auto& [_, i] : order) some.push_back(views[i]);
  return some;
}

// What the draws say of one turned extrinsic, and the last one's reason.
void PrintRow(const char* what,
              double turn_deg,
              const std::vector<std::vector<SceneView>>& draws,
              const Rig& rig,
              const Eigen::Isometry3d& T_camera_lidar) {
  std::array<int, 3> tally{};  // by Agreement
  std::string reason;
  for (const auto& views : draws) {
    const SceneCheck check = CheckScene(views, rig.camera, T_camera_lidar, rig.scene_check);
    ++tally[static_cast<std::size_t>(check.verdict)];
    reason = check.reason;
  }
  std::printf("%-4s %6.2f  %6d  %9d  %11d  %s\n",
              what,
              turn_deg,
              tally[static_cast<std::size_t>(Agreement::kAgrees)],
              tally[static_cast<std::size_t>(Agreement::kDisagrees)],
              tally[static_cast<std::size_t>(Agreement::kCannotTell)],
              reason.c_str());
  std::fflush(stdout);
}

void Print(const Args& args) {
  const Rig rig = LoadRig(args.rig);
  const Eigen::Isometry3d T_camera_lidar = ReadExtrinsic(args.session / "extrinsic.yaml");
  const SessionLog session(args.session);
  SessionViews session_views(
      rig.board, rig.camera, rig.scene_check.view, args.session / kSamplesLogName);
  const auto views = session_views.Of(SamplesWithout(session.samples(), {}));
  const int num_scenes = args.num_scenes == 0 ? static_cast<int>(views.size()) : args.num_scenes;
  std::vector<std::vector<SceneView>> draws;
  for (int i = 0; i < args.num_draws; ++i) {
    draws.push_back(SomeOf(views, num_scenes, {args.seed, NoiseUse::kStops, i}));
  }
  std::printf("%d draws of %d of the %zu scenes\n", args.num_draws, num_scenes, views.size());
  std::puts("axis turn_deg  agrees  disagrees  cannot tell  (the last draw)");
  PrintRow("none", 0, draws, rig, T_camera_lidar);

  const char* const names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double turn_deg : {0.2, -0.2, 0.3, -0.3, 0.5, -0.5, 1.0, -1.0}) {
      Vector6d delta = Vector6d::Zero();
      delta[axis] = turn_deg * kRadPerDeg;
      PrintRow(names[axis], turn_deg, draws, rig, PerturbLeft(T_camera_lidar, delta));
    }
  }
}

}  // namespace

void AddSceneCheckPower(CLI::App* app) {
  CLI::App* figure = app->add_subcommand(
      "scene-check",
      "How large a turn of the extrinsic the scene check notices, and how often it disagrees with "
      "none");
  auto args = std::make_shared<Args>();
  figure->add_option("--rig", args->rig, "The rig file")->required();
  figure
      ->add_option("--session",
                   args->session,
                   "A folder with samples.lcm and extrinsic.yaml, as calibrate writes it")
      ->required();
  figure->add_option("--scenes", args->num_scenes, "Of a draw; 0: all of them")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  figure->add_option("--draws", args->num_draws)->capture_default_str()->check(CLI::PositiveNumber);
  figure->add_option("--seed", args->seed)->capture_default_str();
  figure->callback([args] { Print(*args); });
}

}  // namespace voqcal
