// Calibrations from few poses of one session, scored on the poses that they never saw.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "calibrate/collect.hpp"
#include "common/scratch_folder.hpp"
#include "core/calibration/calibrate.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "figures/figures.hpp"

namespace voqcal {
namespace {

struct SubsetsArgs {
  std::filesystem::path rig;
  InputPaths input;
  int num_poses = 10;
  int num_draws = 50;
  std::uint32_t seed = 1;
};

// What a draw gives, all of its samples being known to agree.
BestExtrinsic RefineDraw(const ChosenSamples& draw, const CalibrationTask& task) {
  const std::vector<const BoardSample*> used = draw.Used();
  const AveragedSets averaged = AverageSets(used, ChooseSets(draw, task).sets, task);
  return RefineBest(used, task.board, task.camera, averaged.average, {}, task.options.refinement);
}

// The first `num` of the samples, as one draw orders them, and the rest.
struct Draw {
  ChosenSamples taken;
  std::vector<const BoardSample*> rest;
};

Draw DrawSubset(const std::vector<const BoardSample*>& samples,
                int num,
                std::uint32_t seed,
                int number) {
  const KeyedNoise noise(seed, NoiseUse::kStops, number);
  std::vector<std::pair<std::uint64_t, const BoardSample*>> order;
  for (std::size_t i = 0; i < samples.size(); ++i) order.emplace_back(noise.Bits(i), samples[i]);
  std::sort(order.begin(), order.end());
  Draw draw;
  for (const auto& [key, sample] : order) {
    if (static_cast<int>(draw.taken.samples.size()) < num) {
      draw.taken.samples.push_back(*sample);
    } else {
      draw.rest.push_back(sample);
    }
  }
  return draw;
}

void PrintSubsets(const SubsetsArgs& args) {
  const Rig rig = LoadRig(args.rig);
  const ScratchFolder scratch(std::filesystem::temp_directory_path() / "voqcal-subsets");
  const auto run = CollectSamples(rig, args.input, scratch.path());
  run->Finish(/*is_collecting_only=*/true);
  const ChosenSamples chosen = ChooseSamples(run->samples(), rig.camera, rig.consistency);
  const std::vector<const BoardSample*> samples = chosen.Used();
  double sum_mm = 0.0;
  double largest_mm = 0.0;
  int num_scored = 0;
  std::puts("draw  method        centre_mm  corner_mm  normal_deg  of the remaining poses");
  for (int i = 0; i < args.num_draws; ++i) {
    const Draw draw = DrawSubset(samples, args.num_poses, args.seed, i);
    const BestExtrinsic best = RefineDraw(draw.taken, rig.Task());
    if (!best.IsUsable()) {
      std::printf("%4d  none: %s\n", i, best.problem.c_str());
      continue;
    }
    const SceneScore score = ScoreCorrected(
        draw.rest, rig.camera, best.T_camera_lidar, best.Bias(), best.chessboard_turn.value_rad);
    std::printf("%4d  %-12s  %9.2f  %9.2f  %10.3f\n",
                i,
                ToString(best.method).c_str(),
                score.centre_mm.mean,
                score.corner_mm.mean,
                score.normal_deg.mean);
    sum_mm += score.centre_mm.mean;
    largest_mm = std::max(largest_mm, score.centre_mm.mean);
    ++num_scored;
  }
  std::printf(
      "%d of %d draws of %d poses: centre error of the remaining poses %.2f mm mean "
      "(asked: 5), worst draw %.2f mm (asked: 9)\n",
      num_scored,
      args.num_draws,
      args.num_poses,
      sum_mm / num_scored,
      largest_mm);
}

}  // namespace

void AddSubsets(CLI::App* app) {
  const auto args = std::make_shared<SubsetsArgs>();
  CLI::App* figure = app->add_subcommand(
      "subsets", "Calibrates from few poses of a session, drawn at random; scores the others");
  figure->add_option("--rig", args->rig, "The rig file (YAML)")->required();
  auto* input = figure->add_option_group("input", "One of:");
  input->add_option("--log", args->input.log, "A recording, or a session's samples.lcm");
  input->add_option("--poses", args->input.poses, "Extracted features: poses.csv");
  input->require_option(1);
  figure->add_option("--num-poses", args->num_poses, "Poses of a draw")->capture_default_str();
  figure->add_option("--draws", args->num_draws, "How many draws")->capture_default_str();
  figure->add_option("--seed", args->seed, "Of the draws")->capture_default_str();
  figure->callback([args] { PrintSubsets(*args); });
}

}  // namespace voqcal
