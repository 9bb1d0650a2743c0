// Each method on some poses of a real session, judged by the others: where the lidar's boards land
// in the image, and by their scenes' edges.

#include <cstdio>
#include <memory>

#include "core/units.hpp"
#include "figures/figures.hpp"
#include "figures/real_session.hpp"

namespace voqcal {
namespace {

struct MethodsArgs {
  std::filesystem::path rig;
  InputPaths input;
  int num_held_out = 10;
  int num_draws = 1;
  std::uint32_t seed = 1;
};

void PrintMethod(const Rig& rig,
                 RefineMethod method,
                 const SessionPoses& taken,
                 const SessionPoses& held_out) {
  CalibrationTask task = rig.Task();
  task.options.refinement.method = method;
  const CalibrationOutcome outcome = CalibratePoses(taken, task);
  if (!outcome.problem.empty()) {
    std::printf("%-12s  none: %s\n", ToString(method).c_str(), outcome.problem.c_str());
    return;
  }
  const BestExtrinsic& refined = outcome.refined;
  const std::vector<BoardSample> samples = SamplesOf(held_out);
  const SceneScore score = ScoreCorrected(SamplesWithout(samples, {}),
                                          rig.camera,
                                          refined.T_camera_lidar,
                                          refined.Bias(),
                                          refined.chessboard_turn.value_rad);
  std::printf("%-12s  %9.2f  %9.2f  %10.3f  %7.4f",
              ToString(method).c_str(),
              score.centre_mm.mean,
              score.corner_mm.mean,
              score.normal_deg.mean,
              JudgeScenes(JudgedScenesOf(held_out), rig.camera, refined.T_camera_lidar));
  if (method == RefineMethod::kJoint) std::printf("  %s", refined.joint.scene.reason.c_str());
  std::printf("\n");
  std::fflush(stdout);
  if (method != RefineMethod::kJoint) return;
  const BestRotation best =
      FindBestRotation(JudgedScenesOf(held_out), rig.camera, refined.T_camera_lidar);
  const Eigen::Vector3d turn_deg = kDegPerRad * best.turn_rad;
  std::printf("best rotation of the judge: %.4f, %.2f %.2f %.2f deg from the joint one\n",
              best.score,
              turn_deg.x(),
              turn_deg.y(),
              turn_deg.z());
}

void PrintMethods(const MethodsArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const std::vector<SessionPose> poses = LoadSession(rig, args.input);
  for (int draw = 0; draw < args.num_draws; ++draw) {
    const SessionPoses order = Shuffled(poses, args.seed, draw);
    const auto border = order.end() - args.num_held_out;
    const SessionPoses taken(order.begin(), border);
    const SessionPoses held_out(border, order.end());
    std::printf("draw %d: %zu poses calibrate, %zu judge\n", draw, taken.size(), held_out.size());
    std::puts("method        centre_mm  corner_mm  normal_deg  scene (higher is better)");
    for (const RefineMethod method : {RefineMethod::kAverage,
                                      RefineMethod::kReprojection,
                                      RefineMethod::kLikelihood,
                                      RefineMethod::kJoint}) {
      PrintMethod(rig, method, taken, held_out);
    }
  }
}

}  // namespace

void AddMethods(CLI::App* app) {
  const auto args = std::make_shared<MethodsArgs>();
  CLI::App* figure = app->add_subcommand(
      "methods",
      "Each method on some poses of a recording, judged by the boards and scenes of others");
  figure->add_option("--rig", args->rig, "The rig file (YAML)")->required();
  figure->add_option("--log", args->input.log, "A recording, or a session's samples.lcm")
      ->required();
  figure->add_option("--held-out", args->num_held_out, "Poses that judge")->capture_default_str();
  figure->add_option("--draws", args->num_draws, "How many draws")->capture_default_str();
  figure->add_option("--seed", args->seed, "Of the draws")->capture_default_str();
  figure->callback([args] { PrintMethods(*args); });
}

}  // namespace voqcal
