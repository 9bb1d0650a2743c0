#include "figures/simulated_rig_session.hpp"

#include "core/assessment/given_session.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

// What a camera makes of a board that it has before it.
std::optional<CameraBoard> Seen(const Eigen::Isometry3d& T_camera_board,
                                const CameraModel& camera,
                                const BoardSpec& board,
                                test::Random* random) {
  constexpr double kCornerNoisePx = 0.1;
  BoardSample sample;
  for (const Eigen::Vector3d& corner_board_m : board.InnerCornersBoardM()) {
    sample.camera.corners_px.push_back(camera.Project(T_camera_board * corner_board_m) +
                                       kCornerNoisePx * random->NormalVector().head<2>());
  }
  GivenSession given{board, camera, {sample}};
  SeeBoardsAgain(&given);
  if (given.samples.empty()) return std::nullopt;
  return given.samples.front().camera;
}

}  // namespace

std::vector<BoardSample> RigSession::Samples(std::size_t lidar, std::size_t camera) const {
  std::vector<BoardSample> samples;
  for (std::size_t stop = 0; stop < lidars.size(); ++stop) {
    if (!lidars[stop][lidar] || !cameras[stop][camera]) continue;
    BoardSample sample;
    sample.id = static_cast<std::int64_t>(stop) + 1;
    sample.lidar = *lidars[stop][lidar];
    sample.camera = *cameras[stop][camera];
    samples.push_back(sample);
  }
  return samples;
}

std::vector<CommonBoard> RigSession::CommonBoards(std::size_t from_camera,
                                                  std::size_t to_camera) const {
  std::vector<CommonBoard> boards;
  for (const auto& at_stop : cameras) {
    const auto& from = at_stop[from_camera];
    const auto& to = at_stop[to_camera];
    if (from && to) boards.push_back({from->pose, to->pose});
  }
  return boards;
}

RigSession SimulateRigSession(const RigSimulationOptions& simulation, const Rig& rig) {
  const RigSimulation world(simulation, rig.board);
  test::Random random(simulation.world.seed);
  RigSession session;
  for (int stop = 0; stop < simulation.world.num_poses; ++stop) {
    const double time_s =
        stop * (simulation.world.hold_s + simulation.world.move_s) + 0.5 * simulation.world.hold_s;
    auto& lidars = session.lidars.emplace_back(simulation.lidars.size());
    auto& cameras = session.cameras.emplace_back(simulation.cameras.size());
    for (std::size_t l = 0; l < lidars.size(); ++l) {
      if (!world.LidarSees(l, time_s)) continue;
      const auto found =
          DetectLidarBoard(world.Sweep(l, time_s), rig.board, rig.lidar_board_detector);
      if (found) lidars[l] = found->front();
    }
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      if (!world.CameraSees(c, time_s)) continue;
      const SimulatedCamera& camera = simulation.cameras[c];
      cameras[c] =
          Seen(camera.T_camera_rig * world.T_rig_board(time_s), camera.model, rig.board, &random);
    }
  }
  return session;
}

}  // namespace voqcal
