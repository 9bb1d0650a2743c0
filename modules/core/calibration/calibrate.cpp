#include "core/calibration/calibrate.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/calibration/likely_cause.hpp"
#include "core/least_samples.hpp"
#include "core/selection/differences_from_others.hpp"
#include "core/selection/pose_variety.hpp"

namespace voqcal {
namespace {

std::int64_t IdOf(const std::vector<BoardSample>& samples, int index) {
  return samples[static_cast<std::size_t>(index)].id;
}

/// Why what agrees is too little to go on; empty if it is not. Where most samples contradict the
/// others, the few that are left and are alike agree by chance: to ask for more of them is no help.
std::string Disagreement(const ChosenSamples& chosen) {
  if (chosen.samples.empty()) return "fewer than three samples: none was taken";
  const std::vector<const BoardSample*> used = chosen.Used();
  const std::string counts =
      std::to_string(used.size()) + " of " + std::to_string(chosen.samples.size());
  if (used.size() < kLeastSamples) {
    return "fewer than three samples that agree with each other: " + counts;
  }
  const bool most_contradict = 2 * used.size() < chosen.samples.size();
  const std::string variety_problem = VarietyProblem(used);
  if (!most_contradict || variety_problem.empty()) return {};
  return "most samples contradict one another; those that agree, " + counts +
         ", are too alike: " + variety_problem;
}

}  // namespace

std::vector<const BoardSample*> ChosenSamples::Used() const {
  std::vector<std::int64_t> left_out_ids;
  for (const RejectedSample& each : rejected) left_out_ids.push_back(each.id);
  return SamplesWithout(samples, left_out_ids);
}

ChosenSamples ChooseSamples(const std::vector<BoardSample>& samples,
                            const CameraModel& camera,
                            const ConsistencyOptions& options) {
  const Consistency consistency = FindConsistent(samples, options);
  ChosenSamples chosen;
  chosen.samples = samples;
  for (const InconsistentSample& each : consistency.inconsistent) {
    chosen.rejected.push_back({IdOf(samples, each.sample), each.reason});
  }
  for (const ChosenCandidate& each : consistency.chosen) {
    TakeCandidate(each.candidate, &chosen.samples[static_cast<std::size_t>(each.sample)]);
    chosen.exchanged.push_back({IdOf(samples, each.sample), each.candidate, each.reason});
  }
  for (const SampleDifference& each : FindOutlying(chosen.Used(), camera)) {
    chosen.rejected.push_back({each.id, ReasonFor(each)});
  }
  std::sort(chosen.rejected.begin(), chosen.rejected.end(), [](const auto& a, const auto& b) {
    return a.id < b.id;
  });
  return chosen;
}

ChosenSets ChooseSets(const ChosenSamples& chosen, const CalibrationTask& task) {
  const SelectionOptions& options = task.options.selection;
  std::vector<BoardSample> used;
  for (const BoardSample* sample : chosen.Used()) used.push_back(*sample);
  ChosenSets result;
  result.problem = Disagreement(chosen);
  if (!result.problem.empty()) {
    const auto likely = LikelyCause(chosen.samples, task);
    if (likely) result.problem += "; likely cause: " + likely->cause + ": " + likely->text;
    return result;
  }
  result.sets = SelectSets(used, task.board, task.camera, options);
  result.lowest_voq = SelectByVoq(used, task.board, options.num_sets);
  if (result.sets.empty()) result.problem = "all boards face the same way: tilt it differently";
  return result;
}

AveragedSets AverageSets(const std::vector<const BoardSample*>& used,
                         const std::vector<VoqSet>& sets,
                         const CalibrationTask& task) {
  AveragedSets result;
  for (const VoqSet& set : sets) {
    std::vector<const BoardSample*> members;
    for (const int i : set.samples) members.push_back(used[static_cast<std::size_t>(i)]);
    result.extrinsics.push_back(
        EstimateSetExtrinsic(members, task.camera, task.options.set_extrinsic));
  }
  result.average = AverageExtrinsics(result.extrinsics, task.options.average);
  if (!result.average.IsUsable()) result.problem = "no set of samples gives an extrinsic";
  return result;
}

CalibrationOutcome Calibrate(const std::vector<BoardSample>& samples,
                             const SceneViewsOf& scene_views,
                             const CalibrationTask& task) {
  CalibrationOutcome outcome;
  outcome.chosen = ChooseSamples(samples, task.camera, task.options.consistency);
  outcome.sets = ChooseSets(outcome.chosen, task);
  outcome.problem = outcome.sets.problem;
  if (!outcome.problem.empty()) return outcome;

  const std::vector<const BoardSample*> used = outcome.chosen.Used();
  outcome.averaged = AverageSets(used, outcome.sets.sets, task);
  outcome.problem = outcome.averaged.problem;
  if (!outcome.problem.empty()) return outcome;

  const AveragedExtrinsic& average = outcome.averaged.average;
  const std::vector<SceneView> views = scene_views ? scene_views(used) : std::vector<SceneView>();
  outcome.refined =
      RefineBest(used, task.board, task.camera, average, views, task.options.refinement);
  outcome.problem = outcome.refined.problem;
  if (!outcome.problem.empty()) return outcome;

  outcome.calibration = Assess(outcome.chosen, average, outcome.refined, scene_views, task);
  return outcome;
}

}  // namespace voqcal
