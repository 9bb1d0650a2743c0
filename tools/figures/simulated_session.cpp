#include "figures/simulated_session.hpp"

#include <cmath>
#include <utility>

#include "core/sampling/sample_picker.hpp"
#include "core/selection/consistency.hpp"
#include "core/simulation/simulation.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {

SimulationOptions FaultySimulation(const Rig& rig, int num_poses, std::uint32_t seed) {
  SimulationOptions simulation = rig.simulation;
  simulation.seed = seed;
  simulation.num_poses = num_poses;
  simulation.common_bias_m = 0.02;
  simulation.dark_bias_m = 0.0075;  // half of the step
  simulation.ring_bias_m = 0.008;
  return simulation;
}

std::vector<BoardSample> SimulateSession(const Rig& rig, const SimulationOptions& simulation) {
  const Simulation world(simulation, rig.board, rig.camera);
  std::vector<BoardSample> samples;
  for (int stop = 0; stop < simulation.num_poses; ++stop) {
    const double time_s = stop * (simulation.hold_s + simulation.move_s) + 0.5 * simulation.hold_s;
    const auto lidar = DetectLidarBoard(world.Sweep(time_s), rig.board, rig.lidar_board_detector);
    const auto camera =
        DetectCameraBoard(world.Image(time_s), rig.camera, rig.board, rig.camera_board_detector);
    if (!lidar || !camera) continue;
    BoardSample sample;
    sample.id = stop + 1;
    sample.utime = kSyntheticEpochUtime + std::llround(1e6 * time_s);
    sample.lidar = lidar->front();
    sample.camera = *camera;
    samples.push_back(sample);
  }
  return ConsistentSamples(samples, FindConsistent(samples, rig.consistency));
}

std::vector<BoardSample> SimulateProjected(const Rig& rig,
                                           const SimulationOptions& simulation,
                                           const SpoiltWorld& spoilt) {
  constexpr double kCornerNoisePx = 0.1;
  const Simulation world(simulation, rig.board, rig.camera);
  test::Random random(simulation.seed);
  std::vector<BoardSample> samples;
  for (int stop = 0; stop < simulation.num_poses; ++stop) {
    const double time_s = stop * (simulation.hold_s + simulation.move_s) + 0.5 * simulation.hold_s;
    const Eigen::Isometry3d T_lidar_board = world.T_lidar_board(time_s);
    PointCloud sweep = world.Sweep(time_s);
    if (spoilt.sweep) spoilt.sweep(T_lidar_board, &sweep);
    const auto found = DetectLidarBoard(sweep, rig.board, rig.lidar_board_detector);
    if (!found) continue;
    BoardSample sample;
    sample.id = stop + 1;
    sample.lidar = found->front();
    Eigen::Isometry3d T_camera_board = simulation.T_camera_lidar * T_lidar_board;
    if (spoilt.T_seen_true) T_camera_board = T_camera_board * spoilt.T_seen_true(stop);
    for (Eigen::Vector3d corner_board_m : rig.board.InnerCornersBoardM()) {
      if (spoilt.corner) spoilt.corner(&corner_board_m);
      sample.camera.corners_px.push_back(rig.camera.Project(T_camera_board * corner_board_m) +
                                         kCornerNoisePx * random.NormalVector().head<2>());
    }
    samples.push_back(std::move(sample));
  }
  return samples;
}

}  // namespace voqcal
