// Speed of the lidar board detector on a whole simulated sweep, and on a denser one.

#include <cmath>
#include <cstdint>

#include <benchmark/benchmark.h>

#include "core/board/lidar_board.hpp"
#include "simulated_scene.hpp"

namespace voqcal {
namespace {

// The first `num_points` of several sweeps of one still scene, each with noise of its own and
// raised by a fraction of the ring spacing: what a lidar of as many times the beams would see.
PointCloud DenseSweep(std::size_t num_points) {
  constexpr double kRingSpacingRad = 2.0 * M_PI / 180.0;
  PointCloud dense = BenchSimulation().Sweep(0.0);
  const std::size_t num_sweeps = (num_points + dense.points.size() - 1) / dense.points.size();
  dense.points.clear();
  for (std::size_t k = 0; k < num_sweeps; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(num_sweeps);
    const auto raise = static_cast<float>(std::tan(kRingSpacingRad * share));
    for (LidarPoint point : BenchSimulation().Sweep(0.01 * static_cast<double>(k)).points) {
      point.position_m.z() += raise * point.position_m.head<2>().norm();
      point.ring = static_cast<std::uint16_t>(point.ring * num_sweeps + k);
      dense.points.push_back(point);
    }
  }
  dense.points.resize(num_points);
  return dense;
}

void DetectLidarBoardIn(benchmark::State& state) {
  const PointCloud cloud = DenseSweep(static_cast<std::size_t>(state.range(0)));
  bool is_found = false;
  for (auto _ : state) {
    is_found = DetectLidarBoard(cloud, test::TestBoard(), {}).has_value();
    benchmark::DoNotOptimize(is_found);
  }
  state.SetLabel(is_found ? "found" : "not found");
}
BENCHMARK(DetectLidarBoardIn)->Arg(24000)->Arg(131000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voqcal
