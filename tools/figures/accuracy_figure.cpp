// How far the likelihood's extrinsic is from the truth of simulated sessions, and how honest its
// covariance is.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/likelihood/likelihood.hpp"
#include "core/median.hpp"
#include "core/units.hpp"
#include "figures/figures.hpp"
#include "figures/simulated_session.hpp"

namespace voqcal {
namespace {

struct AccuracyArgs {
  std::filesystem::path rig;
  int num_runs = 100;
  int num_poses = 50;
  std::uint32_t seed = 1;
};

struct Run {
  Vector6d error;  // of [rotation_rad; translation_m], left side
  LikelihoodUncertainty uncertainty;
};

// Each run has a seed of its own: other stops, ring offsets and noise.
std::vector<Run> RunAll(const AccuracyArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const Eigen::Isometry3d& T_truth = rig.simulation.T_camera_lidar;
  Vector6d start_error;  // about what the VOQ average leaves
  start_error << 0.005, 0.003, -0.004, 0.005, -0.004, 0.006;
  std::vector<Run> runs;
  for (int i = 0; i < args.num_runs; ++i) {
    const std::uint32_t seed = args.seed + static_cast<std::uint32_t>(i);
    const auto samples = SimulateSession(rig, FaultySimulation(rig, args.num_poses, seed));
    std::vector<const BoardSample*> all;
    for (const BoardSample& sample : samples) all.push_back(&sample);
    const LikelihoodExtrinsic refined = RefineByLikelihood(
        all, PerturbLeft(T_truth, start_error), rig.extrinsic_refiner.likelihood);
    if (!refined.IsUsable()) {
      std::printf("seed %u: %s\n", seed, refined.Summary().c_str());
      continue;
    }
    runs.push_back({DifferenceLeft(T_truth, refined.T_camera_lidar), refined.uncertainty});
  }
  return runs;
}

void PrintAccuracy(const AccuracyArgs& args) {
  const std::vector<Run> runs = RunAll(args);
  std::vector<double> rotations_deg, translations_mm;
  double sum_normalised = 0.0;
  for (const Run& run : runs) {
    rotations_deg.push_back(kDegPerRad * run.error.head<3>().norm());
    translations_mm.push_back(1e3 * run.error.tail<3>().norm());
    sum_normalised += run.error.cwiseQuotient(run.uncertainty.by_likelihood).squaredNorm();
  }
  std::printf("%zu of %d runs of %d poses\n", runs.size(), args.num_runs, args.num_poses);
  std::printf("rotation     %.4f deg median (asked: 0.03)\n", Median(rotations_deg));
  std::printf("translation  %.2f mm median (asked: 2)\n", Median(translations_mm));
  // The likelihood's inverse information is the bound for who knows no more than it expects.
  std::printf("RMS error    %.2f times the Cramer-Rao bound (asked: 1.2)\n",
              std::sqrt(sum_normalised / (6.0 * static_cast<double>(runs.size()))));
}

void PrintCoverage(const AccuracyArgs& args) {
  constexpr double kSigmas95 = 1.959964;
  constexpr std::array<const char*, 6> kNames = {"rx", "ry", "rz", "tx", "ty", "tz"};
  const std::vector<Run> runs = RunAll(args);
  const double num_runs = static_cast<double>(runs.size());
  double sum = 0.0;
  std::printf("%zu runs of %d poses; truth within the 95 %% interval (asked: 93 to 97 %%)\n",
              runs.size(),
              args.num_poses);
  std::puts("parameter  inside  RMS error / sigma  mean sigma (deg, mm)");
  for (Eigen::Index i = 0; i < 6; ++i) {
    double num_inside = 0.0;
    double sum_squares = 0.0;
    double sum_sigma = 0.0;
    for (const Run& run : runs) {
      const double sigma = std::sqrt(run.uncertainty.covariance(i, i));
      num_inside += std::abs(run.error[i]) < kSigmas95 * sigma ? 1.0 : 0.0;
      sum_squares += run.error[i] * run.error[i] / (sigma * sigma);
      sum_sigma += sigma;
    }
    sum += num_inside;
    std::printf("%-9s  %5.1f%%  %17.2f  %.4f\n",
                kNames[static_cast<std::size_t>(i)],
                100.0 * num_inside / num_runs,
                std::sqrt(sum_squares / num_runs),
                (i < 3 ? kDegPerRad : 1e3) * sum_sigma / num_runs);
  }
  std::printf("all        %5.1f%%\n", 100.0 * sum / (6.0 * num_runs));
}

void AddFigure(CLI::App* app,
               const char* name,
               const char* what,
               int num_runs,
               void (*print)(const AccuracyArgs&)) {
  const auto args = std::make_shared<AccuracyArgs>();
  args->num_runs = num_runs;
  CLI::App* figure = app->add_subcommand(name, what);
  figure->add_option("--rig", args->rig, "A simulated rig (YAML)")->required();
  figure->add_option("--runs", args->num_runs, "Simulated sessions")->capture_default_str();
  figure->add_option("--num-poses", args->num_poses, "Poses of a session")->capture_default_str();
  figure->add_option("--seed", args->seed, "Of the first run; the others follow")
      ->capture_default_str();
  figure->callback([args, print] { print(*args); });
}

}  // namespace

void AddAccuracy(CLI::App* app) {
  AddFigure(app,
            "accuracy",
            "Error of the extrinsic against the truth of sessions with a faulty lidar",
            100,
            PrintAccuracy);
}

void AddCoverage(CLI::App* app) {
  AddFigure(app,
            "coverage",
            "How often the covariance's 95 % intervals contain the truth, on such sessions",
            400,
            PrintCoverage);
}

}  // namespace voqcal
