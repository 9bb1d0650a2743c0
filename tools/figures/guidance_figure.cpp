// voqcal_figures guidance: how many poses an accuracy takes, following the guidance or at random.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "core/median.hpp"
#include "figures/figures.hpp"
#include "figures/simulated_session.hpp"
#include "support/guided_session.hpp"

namespace voqcal {
namespace {

struct GuidanceArgs {
  std::filesystem::path rig;
  int num_runs = 50;
  int num_poses = 25;
  std::uint32_t seed = 1;
};

using Sessions = std::vector<std::vector<test::GuidedStep>>;

enum class Poses {
  kGuided,          // as asked, give or take 0.2 m and 10 degrees
  kRandom,          // anywhere in view, turned by any angle about the normal
  kRandomDiamonds,  // the same, but within 15 degrees of a diamond, as the README advises
};

Sessions Run(const GuidanceArgs& args,
             const Rig& rig,
             const GuidanceOptions& guidance,
             Poses poses) {
  constexpr double kDiamondRad = 15.0 * M_PI / 180.0;
  Sessions sessions;
  for (int run = 0; run < args.num_runs; ++run) {
    const std::uint32_t seed = args.seed + static_cast<std::uint32_t>(run);
    test::GuidedSessionOptions session;
    session.simulation = FaultySimulation(rig, args.num_poses, seed);
    session.lidar_board_detector = rig.lidar_board_detector;
    session.is_guided = poses == Poses::kGuided;
    if (poses == Poses::kRandomDiamonds) session.max_random_roll_rad = kDiamondRad;
    session.num_poses = args.num_poses;
    session.seed = seed;
    sessions.push_back(test::SimulateGuidedSession(
        session, {rig.board, rig.camera, rig.extrinsic_refiner.likelihood}, guidance));
  }
  return sessions;
}

// Of all sessions, for each number of poses.
std::vector<double> Medians(const Sessions& sessions, double test::GuidedStep::*error) {
  std::vector<double> medians;
  for (std::size_t i = 0; i < sessions.front().size(); ++i) {
    std::vector<double> values;
    for (const auto& steps : sessions) values.push_back(steps[i].*error);
    medians.push_back(Median(values));
  }
  return medians;
}

void PrintCurves(const Sessions (&kinds)[3]) {
  std::puts("poses  guided: predicted  true   random: predicted  true   diamonds: predicted  true");
  for (std::size_t i = 0; i < kinds[0].front().size(); ++i) {
    std::printf("%5zu", i + 1);
    for (const Sessions& sessions : kinds) {
      std::printf("  %17.2f  %5.2f",
                  Medians(sessions, &test::GuidedStep::predicted_error)[i],
                  Medians(sessions, &test::GuidedStep::true_error)[i]);
    }
    std::puts("");
  }
}

// A person who holds the board where no detector finds it has held it there all the same.
void PrintHolds(const Sessions (&kinds)[3]) {
  const auto holds_a_sample = [](const Sessions& sessions) {
    double sum = 0.0;
    for (const auto& steps : sessions) sum += steps.back().num_holds;
    return sum / static_cast<double>(sessions.size() * sessions.front().size());
  };
  std::printf(
      "holds in both sensors' sight for each sample: guided %.3f, random %.3f, diamonds %.3f\n",
      holds_a_sample(kinds[0]),
      holds_a_sample(kinds[1]),
      holds_a_sample(kinds[2]));
}

// Poses needed; one more than there are if they did not do, and the ratio then is at most so large.
void PrintNeeded(const Sessions (&kinds)[3]) {
  std::puts("poses needed (asked: guided at most 0.5 of random)");
  std::puts("by         tolerance mm  guided  random  ratio  diamonds  ratio");
  for (const double tolerance_mm : {7.0, 5.0, 4.0, 3.0, 2.5}) {
    for (const auto& [what, error] : {std::pair{"predicted", &test::GuidedStep::predicted_error},
                                      std::pair{"true", &test::GuidedStep::true_error}}) {
      const auto needed = [&, error = error](const Sessions& sessions) {
        return test::PosesNeeded(Medians(sessions, error), tolerance_mm);
      };
      const int guided = needed(kinds[0]);
      const int at_random = needed(kinds[1]);
      const int diamonds = needed(kinds[2]);
      std::printf("%-9s  %12.1f  %6d  %6d  %5.2f  %8d  %5.2f\n",
                  what,
                  tolerance_mm,
                  guided,
                  at_random,
                  static_cast<double>(guided) / at_random,
                  diamonds,
                  static_cast<double>(guided) / diamonds);
    }
  }
}

void Print(const GuidanceArgs& args) {
  const Rig rig = LoadRig(args.rig);
  GuidanceOptions guidance = rig.pose_guide;
  guidance.limits.min_distance_m = rig.simulation.min_distance_m;
  guidance.limits.max_distance_m = rig.simulation.max_distance_m;
  const Sessions kinds[3] = {Run(args, rig, guidance, Poses::kGuided),
                             Run(args, rig, guidance, Poses::kRandom),
                             Run(args, rig, guidance, Poses::kRandomDiamonds)};
  std::printf("worst error of the scene, %s, median of %d runs\n",
              ToString(guidance.enough.tolerance.unit).c_str(),
              args.num_runs);
  PrintCurves(kinds);
  PrintHolds(kinds);
  PrintNeeded(kinds);
}

}  // namespace

void AddGuidance(CLI::App* app) {
  const auto args = std::make_shared<GuidanceArgs>();
  CLI::App* figure = app->add_subcommand(
      "guidance", "Poses that an accuracy takes: following the guidance, or at random");
  figure->add_option("--rig", args->rig, "A simulated rig (YAML)")->required();
  figure->add_option("--runs", args->num_runs, "Simulated sessions of each kind")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  figure->add_option("--num-poses", args->num_poses, "Poses of a session")->capture_default_str();
  figure->add_option("--seed", args->seed, "Of the first run; the others follow")
      ->capture_default_str();
  figure->callback([args] { Print(*args); });
}

}  // namespace voqcal
