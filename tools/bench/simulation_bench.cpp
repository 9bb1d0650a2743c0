// Speed of the simulated sensors, once the room is painted.

#include <cmath>

#include <benchmark/benchmark.h>

#include "core/simulation/clutter.hpp"
#include "core/simulation/lidar_simulator.hpp"
#include "simulated_scene.hpp"

namespace voqcal {
namespace {

void SimulateSweep(benchmark::State& state) {
  static const Simulation simulation = BenchSimulation();
  double time_s = 0;
  for (auto _ : state) benchmark::DoNotOptimize(simulation.Sweep(time_s += 0.1));
}
BENCHMARK(SimulateSweep)->Unit(benchmark::kMillisecond);

// One sweep of each pattern, board at 1.5 to 4.5 m, in a cluttered room.
void SimulatePattern(benchmark::State& state) {
  const BoardSpec board = test::TestBoard();
  SimulationOptions options;
  options.scan.pattern = static_cast<ScanPattern>(state.range(0));
  const LidarSimulator lidar(
      options, board, Room(DrawClutter({}, board, Room().Interior(), options.seed)));
  static const Simulation simulation = BenchSimulation();
  state.SetLabel(ToString(options.scan.pattern));
  double time_s = 0;
  for (auto _ : state) {
    time_s += 0.1;
    benchmark::DoNotOptimize(
        lidar.Sweep(simulation.T_lidar_board(time_s), std::llround(time_s * 1e6)));
  }
}
BENCHMARK(SimulatePattern)->DenseRange(0, 4)->Unit(benchmark::kMillisecond);

void SimulateImage(benchmark::State& state) {
  static const Simulation simulation = BenchSimulation();
  double time_s = 0;
  for (auto _ : state) benchmark::DoNotOptimize(simulation.Image(time_s += 0.1));
}
BENCHMARK(SimulateImage)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voqcal
