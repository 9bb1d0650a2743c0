// voqcal_figures guidance: how many poses an accuracy takes, following the guidance or at random.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "figures/figures.hpp"
#include "figures/simulated_session.hpp"
#include "support/guided_session.hpp"

namespace voqcal {
namespace {

struct GuidanceArgs {
  std::filesystem::path rig;
  int num_runs = 50;
  int num_poses = 40;
  std::uint32_t seed = 1;
  double max_range_m = 5.0;
};

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? std::nan("") : values[values.size() / 2];
}

using Sessions = std::vector<std::vector<test::GuidedStep>>;

Sessions Run(const GuidanceArgs& args,
             const Rig& rig,
             const GuidanceOptions& guidance,
             bool is_guided) {
  Sessions sessions;
  for (int run = 0; run < args.num_runs; ++run) {
    const std::uint32_t seed = args.seed + static_cast<std::uint32_t>(run);
    test::GuidedSessionOptions session;
    session.simulation = FaultySimulation(rig, args.num_poses, seed);
    session.lidar_board_detector = rig.lidar_board_detector;
    session.is_guided = is_guided;
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

void PrintRow(const char* what,
              const std::vector<double>& guided,
              const std::vector<double>& at_random,
              double tolerance_mm) {
  const int num_guided = test::PosesNeeded(guided, tolerance_mm);
  const int num_random = test::PosesNeeded(at_random, tolerance_mm);
  const bool is_reached = num_random <= static_cast<int>(at_random.size());
  std::printf("%-10s  %12.1f  %6d  %s%5d  %5.2f\n",
              what,
              tolerance_mm,
              num_guided,
              is_reached ? " " : ">",
              is_reached ? num_random : num_random - 1,
              static_cast<double>(num_guided) / num_random);
}

void Print(const GuidanceArgs& args) {
  const Rig rig = LoadRig(args.rig);
  GuidanceOptions guidance;
  guidance.tolerance.max_range_m = args.max_range_m;
  guidance.limits.min_distance_m = rig.simulation.min_distance_m;
  guidance.limits.max_distance_m = rig.simulation.max_distance_m;
  const Sessions guided = Run(args, rig, guidance, true);
  const Sessions at_random = Run(args, rig, guidance, false);
  const auto predicted = &test::GuidedStep::predicted_error;
  const auto truth = &test::GuidedStep::true_error;
  const auto guided_predicted = Medians(guided, predicted);
  const auto guided_true = Medians(guided, truth);
  const auto random_predicted = Medians(at_random, predicted);
  const auto random_true = Medians(at_random, truth);
  std::printf("worst error up to %.0f m, mm, median of %d runs\n", args.max_range_m, args.num_runs);
  std::puts("poses  guided: predicted  true   random: predicted  true");
  for (std::size_t i = 0; i < guided_true.size(); ++i) {
    std::printf("%5zu  %17.2f  %4.2f  %18.2f  %4.2f\n",
                i + 1,
                guided_predicted[i],
                guided_true[i],
                random_predicted[i],
                random_true[i]);
  }
  std::puts("poses needed (asked: at most half of the random ones)");
  std::puts("by          tolerance mm  guided  random  ratio");
  for (const double tolerance_mm : {10.0, 7.0, 5.0, 4.0, 3.0}) {
    PrintRow("predicted", guided_predicted, random_predicted, tolerance_mm);
    PrintRow("true", guided_true, random_true, tolerance_mm);
  }
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
  figure->add_option("--range", args->max_range_m, "Up to where the error counts, metres")
      ->capture_default_str();
  figure->add_option("--seed", args->seed, "Of the first run; the others follow")
      ->capture_default_str();
  figure->callback([args] { Print(*args); });
}

}  // namespace voqcal
