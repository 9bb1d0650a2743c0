// Speed of the lidar board detector on whole sweeps, simulated and real.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/lidar_detection/lidar_board.hpp"
#include "core/median.hpp"
#include "simulated_scene.hpp"
#include "support/real_data.hpp"
#include "support/real_sweeps.hpp"

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

/// Sweeps of a session in turn: a sweep's cost depends on where the board is, so the median tells.
void DetectLidarBoardOver(benchmark::State& state,
                          const std::vector<PointCloud>& clouds,
                          const BoardSpec& board) {
  std::vector<double> times_ms;
  std::size_t num_found = 0;
  for (auto _ : state) {
    const PointCloud& cloud = clouds[times_ms.size() % clouds.size()];
    const auto start = std::chrono::steady_clock::now();
    num_found += DetectLidarBoard(cloud, board, {}).has_value();
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start;
    times_ms.push_back(elapsed.count());
  }
  std::size_t num_points = 0;
  for (const PointCloud& cloud : clouds) num_points += cloud.points.size();
  state.counters["median_ms"] = Median(times_ms);
  state.counters["points"] = static_cast<double>(num_points) / static_cast<double>(clouds.size());
  state.counters["found"] = static_cast<double>(num_found) / static_cast<double>(times_ms.size());
}

/// The stops of a simulated session.
void DetectLidarBoardOverSession(benchmark::State& state, ScanPattern pattern) {
  const Simulation simulation = BenchSimulation(pattern);
  const SimulationOptions script;
  std::vector<PointCloud> clouds;
  for (int pose = 0; pose < script.num_poses; ++pose) {
    clouds.push_back(simulation.Sweep(pose * (script.hold_s + script.move_s)));
  }
  DetectLidarBoardOver(state, clouds, test::TestBoard());
}
BENCHMARK_CAPTURE(DetectLidarBoardOverSession, vlp16, ScanPattern::kVlp16)
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);
BENCHMARK_CAPTURE(DetectLidarBoardOverSession, spinning_128, ScanPattern::kSpinning128)
    ->Unit(benchmark::kMillisecond)
    ->MinTime(2.0);

/// The whole sweeps of the real session; without its data there is nothing to time.
void DetectLidarBoardOverRealSession(benchmark::State& state) {
  const auto folder = test::RealDataFolder();
  if (!folder) return state.SkipWithError("no ../shared/data on this machine");
  std::vector<PointCloud> clouds;
  for (const auto& entry : std::filesystem::directory_iterator(*folder / "acfr-vlp16/pcd")) {
    if (entry.path().string().find("_full") == std::string::npos) continue;
    clouds.push_back(test::LoadPcd(entry.path()));
  }
  DetectLidarBoardOver(state, clouds, test::kAcfrBoard);
}
BENCHMARK(DetectLidarBoardOverRealSession)->Unit(benchmark::kMillisecond)->MinTime(2.0);

}  // namespace
}  // namespace voqcal
