// voqcal_figures consistency: how surely wrong samples are found before any extrinsic is known.

#include "core/selection/consistency.hpp"

#include <cstdio>
#include <memory>

#include "figures/figures.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

struct Args {
  std::uint32_t seed = 1;
  int num_runs = 500;
  double common_offset_m = 0.02;
};

struct Counts {
  int found = 0;       // wrong samples that were dropped
  int wrong = 0;       // wrong samples
  int dropped = 0;     // right samples that were dropped
  int right = 0;       // right samples
  int not_mended = 0;  // wrong first candidates whose right runner-up was not taken
};

// Noise as a VLP-16's boards have it, and a range offset that all share.
std::vector<BoardSample> Scene(int num_samples,
                               int num_wrong,
                               std::uint32_t seed,
                               double offset_m) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.num_outliers = num_wrong;  // the first
  scene.lidar_rotation_noise_rad = 0.015;
  scene.lidar_centre_noise_m = 0.008;
  scene.seed = seed;
  std::vector<BoardSample> samples = test::SynthesizeSamples(scene);
  for (BoardSample& sample : samples) {
    const Eigen::Vector3d ray = sample.lidar.pose.centre_m.normalized();
    sample.lidar.pose.centre_m += offset_m * ray;
  }
  return samples;
}

// The same scene with the right board as the wrong samples' runner-up.
std::vector<BoardSample> WithRunnersUp(std::vector<BoardSample> samples,
                                       const std::vector<BoardSample>& right,
                                       int num_wrong) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(num_wrong); ++i) {
    samples[i].runners_up = {right[i].lidar};
  }
  return samples;
}

Counts CountOver(const Args& args, int num_samples, int num_wrong) {
  Counts counts;
  for (int run = 0; run < args.num_runs; ++run) {
    const std::uint32_t seed = args.seed + static_cast<std::uint32_t>(run);
    const auto samples = Scene(num_samples, num_wrong, seed, args.common_offset_m);
    const Consistency found = FindConsistent(samples, {});
    for (const InconsistentSample& each : found.inconsistent) {
      ++(each.sample < num_wrong ? counts.found : counts.dropped);
    }
    counts.wrong += num_wrong;
    counts.right += num_samples - num_wrong;
    const auto right = Scene(num_samples, 0, seed, args.common_offset_m);
    const Consistency mended = FindConsistent(WithRunnersUp(samples, right, num_wrong), {});
    counts.not_mended += num_wrong - static_cast<int>(mended.chosen.size());
  }
  return counts;
}

void Measure(const Args& args) {
  std::printf(
      "%d runs each; all ranges off by %.0f mm\n", args.num_runs, 1e3 * args.common_offset_m);
  std::puts("samples  wrong   wrong found   right dropped   right runner-up not taken");
  for (const int num_samples : {10, 20, 30, 50}) {
    for (const int percent : {10, 20, 30}) {
      const int num_wrong = num_samples * percent / 100;
      const Counts counts = CountOver(args, num_samples, num_wrong);
      std::printf("%7d  %3d %%   %9.3f %%   %11.3f %%   %23.3f %%\n",
                  num_samples,
                  percent,
                  100.0 * counts.found / counts.wrong,
                  100.0 * counts.dropped / counts.right,
                  100.0 * counts.not_mended / counts.wrong);
    }
  }
}

}  // namespace

void AddConsistency(CLI::App* app) {
  auto* command = app->add_subcommand(
      "consistency", "Wrong samples among right ones: how many are found, how many right ones go");
  const auto args = std::make_shared<Args>();
  command->add_option("--seed", args->seed, "Of the first run; the others count on");
  command->add_option("--runs", args->num_runs, "Runs of each line")->check(CLI::PositiveNumber);
  command->add_option("--offset", args->common_offset_m, "Range offset of the lidar, metres");
  command->callback([args] { Measure(*args); });
}

}  // namespace voqcal
