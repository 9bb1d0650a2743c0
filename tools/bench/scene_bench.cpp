// Speed of what the live page does with each sweep that it shows, beside projecting it alone.

#include <benchmark/benchmark.h>

#include "core/scene/points_in_sight.hpp"
#include "simulated_scene.hpp"

namespace voqcal {
namespace {

void PixelsInSightOf(benchmark::State& state, ScanPattern pattern) {
  const PointCloud cloud = BenchSimulation(pattern).Sweep(0.0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(PixelsInSight(cloud, test::TestCamera(), test::TestExtrinsic()));
  }
  state.counters["points"] = static_cast<double>(cloud.points.size());
}
BENCHMARK_CAPTURE(PixelsInSightOf, vlp16, ScanPattern::kVlp16)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PixelsInSightOf, spinning_128, ScanPattern::kSpinning128)
    ->Unit(benchmark::kMillisecond);

void ProjectPointsOf(benchmark::State& state, ScanPattern pattern) {
  const PointCloud cloud = BenchSimulation(pattern).Sweep(0.0);
  const CameraModel camera = test::TestCamera();
  const Eigen::Isometry3d T_camera_lidar = test::TestExtrinsic();
  for (auto _ : state) {
    for (const LidarPoint& point : cloud.points) {
      benchmark::DoNotOptimize(
          camera.ProjectIfInFront<double>(T_camera_lidar * point.position_m.cast<double>()));
    }
  }
  state.counters["points"] = static_cast<double>(cloud.points.size());
}
BENCHMARK_CAPTURE(ProjectPointsOf, vlp16, ScanPattern::kVlp16)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ProjectPointsOf, spinning_128, ScanPattern::kSpinning128)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace voqcal
