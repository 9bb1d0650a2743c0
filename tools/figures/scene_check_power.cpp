// How large a turn of the extrinsic the scene check notices, on the scenes of a session.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "core/scene/scene_check.hpp"
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
};

void PrintRow(const char* what, double turn_deg, const SceneCheck& check) {
  std::printf("%-4s %6.2f  %-10s  %s\n",
              what,
              turn_deg,
              ToString(check.verdict).c_str(),
              check.reason.c_str());
  std::fflush(stdout);
}

void Print(const Args& args) {
  const Rig rig = LoadRig(args.rig);
  const Eigen::Isometry3d T_camera_lidar = ReadExtrinsic(args.session / "extrinsic.yaml");
  const SessionLog session(args.session);
  SessionViews session_views(
      rig.board, rig.camera, rig.scene_check.view, args.session / kSamplesLogName);
  const auto views = session_views.Of(SamplesWithout(session.samples(), {}));
  std::puts("axis turn_deg  verdict");
  const auto print = [&](const char* what, int axis, double turn_deg) {
    Vector6d delta = Vector6d::Zero();
    delta[axis] = turn_deg * kRadPerDeg;
    const Eigen::Isometry3d T_turned = PerturbLeft(T_camera_lidar, delta);
    PrintRow(what, turn_deg, CheckScene(views, rig.camera, T_turned, rig.scene_check));
  };
  print("none", 0, 0);
  const char* const names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double turn_deg : {0.2, 0.3, 0.4, 0.5, 0.7, 1.0}) {
      print(names[axis], axis, turn_deg);
      print(names[axis], axis, -turn_deg);
    }
  }
}

}  // namespace

void AddSceneCheckPower(CLI::App* app) {
  CLI::App* figure = app->add_subcommand(
      "scene-check", "How large a turn of the extrinsic the scene check notices (no seed)");
  auto args = std::make_shared<Args>();
  figure->add_option("--rig", args->rig, "The rig file")->required();
  figure
      ->add_option("--session",
                   args->session,
                   "A folder with samples.lcm and extrinsic.yaml, as calibrate writes it")
      ->required();
  figure->callback([args] { Print(*args); });
}

}  // namespace voqcal
