// Speed of the simulated sensors, once the room is painted.

#include <benchmark/benchmark.h>

#include "simulated_scene.hpp"

namespace voqcal {
namespace {

void SimulateSweep(benchmark::State& state) {
  const Simulation& simulation = BenchSimulation();
  double time_s = 0;
  for (auto _ : state) benchmark::DoNotOptimize(simulation.Sweep(time_s += 0.1));
}
BENCHMARK(SimulateSweep)->Unit(benchmark::kMillisecond);

void SimulateImage(benchmark::State& state) {
  const Simulation& simulation = BenchSimulation();
  double time_s = 0;
  for (auto _ : state) benchmark::DoNotOptimize(simulation.Image(time_s += 0.1));
}
BENCHMARK(SimulateImage)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voqcal
