// Speed of the lidar board detector on whole simulated sweeps.

#include <benchmark/benchmark.h>

#include "core/board/lidar_board.hpp"
#include "simulated_scene.hpp"

namespace voqcal {
namespace {

void DetectLidarBoardIn(benchmark::State& state, ScanPattern pattern) {
  const PointCloud cloud = BenchSimulation(pattern).Sweep(0.0);
  bool is_found = false;
  for (auto _ : state) {
    is_found = DetectLidarBoard(cloud, test::TestBoard(), {}).has_value();
    benchmark::DoNotOptimize(is_found);
  }
  state.counters["points"] = static_cast<double>(cloud.points.size());
  state.SetLabel(is_found ? "found" : "not found");
}
BENCHMARK_CAPTURE(DetectLidarBoardIn, vlp16, ScanPattern::kVlp16)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(DetectLidarBoardIn, spinning_128, ScanPattern::kSpinning128)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voqcal
