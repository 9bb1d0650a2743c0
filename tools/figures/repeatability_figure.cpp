// Few poses of a real session against the rest of it: are the stated intervals honest, and is what
// is called usable?

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "figures/figures.hpp"
#include "figures/real_session.hpp"

namespace voqcal {
namespace {

struct RepeatabilityArgs {
  std::filesystem::path rig;
  InputPaths input;
  std::vector<int> sizes = {6, 8, 10};
  int num_draws = 16;
  std::string method = "automatic";
  std::uint32_t seed = 1;
};

// Of the draws of one size.
struct Tally {
  Vector6d sum_squares = Vector6d::Zero();  // of differences over their stated sigma
  int num_compared = 0;
  int num_usable = 0;
  int num_usable_off = 0;  // ... and off by more than 10 mm
};

void Compare(const CalibrationOutcome& few, const CalibrationOutcome& rest, Tally* tally) {
  constexpr double kOff_m = 0.010;
  if (!few.problem.empty() || !rest.problem.empty()) return;
  const Vector6d difference =
      DifferenceLeft(rest.refined.T_camera_lidar, few.refined.T_camera_lidar);
  const Vector6d variance =
      few.refined.covariance_given_rig.diagonal() + rest.refined.covariance_given_rig.diagonal();
  tally->sum_squares += difference.cwiseAbs2().cwiseQuotient(variance);
  ++tally->num_compared;
  if (VerdictOf(few.calibration).grade == Grade::kBad) return;
  ++tally->num_usable;
  if (difference.tail<3>().norm() > kOff_m) ++tally->num_usable_off;
}

void PrintRepeatability(const RepeatabilityArgs& args) {
  const Rig rig = LoadRig(args.rig);
  CalibrationTask task = rig.Task();
  if (args.method != "automatic") {
    task.options.refinement.method = RefineMethodFromString(args.method);
  }
  const std::vector<SessionPose> poses = LoadSession(rig, args.input);
  std::puts(
      "poses  of  draws  RMS of difference over sigma: rx ry rz tx ty tz  worst (asked: 1.5)"
      "  usable  and 10 mm off (asked: 0)");
  for (const int size : args.sizes) {
    Tally tally;
    for (int draw = 0; draw < args.num_draws; ++draw) {
      const SessionPoses order = Shuffled(poses, args.seed, draw);
      if (static_cast<std::size_t>(size) >= order.size()) continue;
      const auto border = order.begin() + size;
      Compare(CalibratePoses({order.begin(), border}, task),
              CalibratePoses({border, order.end()}, task),
              &tally);
    }
    const Vector6d rms = (tally.sum_squares / tally.num_compared).cwiseSqrt();
    std::printf("%5d  %2zu  %5d  %.2f %.2f %.2f %.2f %.2f %.2f  %.2f  %6d  %d\n",
                size,
                poses.size(),
                tally.num_compared,
                rms[0],
                rms[1],
                rms[2],
                rms[3],
                rms[4],
                rms[5],
                rms.maxCoeff(),
                tally.num_usable,
                tally.num_usable_off);
    std::fflush(stdout);
  }
}

}  // namespace

void AddRepeatability(CLI::App* app) {
  const auto args = std::make_shared<RepeatabilityArgs>();
  CLI::App* figure = app->add_subcommand(
      "repeatability", "Few poses of a recording, drawn at random, against the rest of it");
  figure->add_option("--rig", args->rig, "The rig file (YAML)")->required();
  figure->add_option("--log", args->input.log, "A recording, or a session's samples.lcm")
      ->required();
  figure->add_option("--sizes", args->sizes, "Poses of a draw")->delimiter(',');
  figure->add_option("--draws", args->num_draws, "How many of each size")->capture_default_str();
  figure
      ->add_option("--method", args->method, "automatic, joint, likelihood, reprojection, average")
      ->capture_default_str();
  figure->add_option("--seed", args->seed, "Of the draws")->capture_default_str();
  figure->callback([args] { PrintRepeatability(*args); });
}

}  // namespace voqcal
