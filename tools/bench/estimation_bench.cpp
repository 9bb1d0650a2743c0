// Speed of selection and estimation on synthetic samples of the real session's geometry.

#include <benchmark/benchmark.h>

#include "core/assessment/best_extrinsic.hpp"
#include "core/assessment/scores.hpp"
#include "core/estimation/average.hpp"
#include "core/selection/consistency.hpp"
#include "core/selection/select_sets.hpp"
#include "core/selection/voq.hpp"
#include "study/all_sets.hpp"
#include "support/synthetic_samples.hpp"
#include "support/synthetic_sweeps.hpp"

namespace voqcal {
namespace {

std::vector<BoardSample> NoisySamples(int num_samples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.lidar_rotation_noise_rad = 0.015;
  scene.lidar_centre_noise_m = 0.008;
  scene.edge_noise_m = 0.008;
  return test::SynthesizeSamples(scene);
}

std::vector<SetExtrinsic> EstimateSets(const std::vector<BoardSample>& samples, int num_sets) {
  std::vector<SetExtrinsic> extrinsics;
  for (const VoqSet& set : SelectByVoq(samples, test::TestBoard(), num_sets)) {
    std::vector<const BoardSample*> members;
    for (const int i : set.samples) members.push_back(&samples[static_cast<std::size_t>(i)]);
    extrinsics.push_back(EstimateSetExtrinsic(members, test::TestCamera(), {}));
  }
  return extrinsics;
}

void SelectByVoqOf(benchmark::State& state) {
  const auto samples = NoisySamples(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(SelectByVoq(samples, test::TestBoard(), 50));
}
BENCHMARK(SelectByVoqOf)->Arg(30)->Arg(50)->Arg(200)->Arg(1000)->Unit(benchmark::kMillisecond);

// No bound prunes here: every combination is looked at.
void SelectBySceneErrorOf(benchmark::State& state) {
  const auto samples = NoisySamples(static_cast<int>(state.range(0)));
  SelectionOptions options;
  options.criterion = SelectionCriterion::kSceneError;
  for (auto _ : state) {
    benchmark::DoNotOptimize(SelectSets(samples, test::TestBoard(), test::TestCamera(), options));
  }
}
BENCHMARK(SelectBySceneErrorOf)->Arg(50)->Arg(200)->Unit(benchmark::kMillisecond);

// Every set of N poses: all figures, solved and scored over the scene. 50 poses are 19,600 sets.
void StudyAllSetsOf(benchmark::State& state) {
  const auto samples = NoisySamples(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(StudyAllSets(samples, test::TestBoard(), test::TestCamera(), {}));
  }
}
BENCHMARK(StudyAllSetsOf)->Arg(50)->Unit(benchmark::kMillisecond);

void FindConsistentOf(benchmark::State& state) {
  const auto samples = NoisySamples(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(FindConsistent(samples, {}));
}
BENCHMARK(FindConsistentOf)->Arg(30)->Arg(200)->Arg(1000)->Unit(benchmark::kMillisecond);

// Selection and solution; 19,600 is every set of 50 poses.
void EstimateSetsOf(benchmark::State& state) {
  const auto samples = NoisySamples(50);
  for (auto _ : state) {
    benchmark::DoNotOptimize(EstimateSets(samples, static_cast<int>(state.range(0))));
  }
}
BENCHMARK(EstimateSetsOf)->Arg(50)->Arg(19600)->Unit(benchmark::kMillisecond);

void RefineExtrinsicOf(benchmark::State& state) {
  const auto samples = NoisySamples(static_cast<int>(state.range(0)));
  const auto all = test::Pointers(samples);
  for (auto _ : state) {
    benchmark::DoNotOptimize(RefineExtrinsic(all, test::TestCamera(), test::TestExtrinsic(), {}));
  }
}
BENCHMARK(RefineExtrinsicOf)->Arg(30)->Unit(benchmark::kMillisecond);

void LeaveOneOutScoreOf(benchmark::State& state) {
  const auto samples = NoisySamples(static_cast<int>(state.range(0)));
  const auto all = test::Pointers(samples);
  for (auto _ : state) {
    benchmark::DoNotOptimize(LeaveOneOutScore(all, test::TestCamera(), test::TestExtrinsic(), {}));
  }
}
BENCHMARK(LeaveOneOutScoreOf)->Arg(30)->Unit(benchmark::kMillisecond);

std::vector<BoardSample> SamplesWithSweeps(int num_samples) {
  test::SyntheticSamplesOptions scene;
  scene.num_samples = num_samples;
  scene.lidar_rotation_noise_rad = 0.003;
  scene.lidar_centre_noise_m = 0.002;
  return test::SamplesWithSweeps(scene, {0.02, 0.015, 0.008, 0.01});
}

void RefineByLikelihoodOf(benchmark::State& state) {
  const auto samples = SamplesWithSweeps(static_cast<int>(state.range(0)));
  const auto all = test::Pointers(samples);
  for (auto _ : state) {
    benchmark::DoNotOptimize(RefineByLikelihood(all, test::TestExtrinsic(), {}));
  }
}
BENCHMARK(RefineByLikelihoodOf)->Arg(30)->Unit(benchmark::kMillisecond);

// Every method, each with its leave-one-out.
void RefineBestOf(benchmark::State& state) {
  const auto samples = SamplesWithSweeps(static_cast<int>(state.range(0)));
  const auto all = test::Pointers(samples);
  AveragedExtrinsic average;
  average.T_camera_lidar = test::TestExtrinsic();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        RefineBest(all, test::TestBoard(), test::TestCamera(), average, {}, RefinerOptions{}));
  }
}
BENCHMARK(RefineBestOf)->Arg(30)->Unit(benchmark::kMillisecond);

// What `calibrate --poses` computes: selection, all solutions, average, refinement.
void WholePipelineOf(benchmark::State& state) {
  const auto samples = NoisySamples(static_cast<int>(state.range(0)));
  const auto all = test::Pointers(samples);
  for (auto _ : state) {
    const AveragedExtrinsic average = AverageExtrinsics(EstimateSets(samples, 50), {});
    benchmark::DoNotOptimize(RefineExtrinsic(all, test::TestCamera(), average.T_camera_lidar, {}));
  }
}
BENCHMARK(WholePipelineOf)->Arg(30)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voqcal
