#include "core/simulation/rig_simulation.hpp"

#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/camera_detection/calibration_target.hpp"
#include "core/problems.hpp"
#include "core/simulation/board_script.hpp"
#include "core/simulation/camera_simulator.hpp"
#include "core/simulation/clutter.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/lidar_simulator.hpp"
#include "core/simulation/room.hpp"
#include "core/simulation/stop_checks.hpp"
#include "core/simulation/stop_finder.hpp"

namespace voqcal {
namespace {

std::int64_t Microseconds(double time_s) { return std::llround(time_s * 1e6); }

// Noise and faults of a sensor are its own.
SimulationOptions WithSeedOf(const std::string& sensor, SimulationOptions options) {
  std::uint64_t seed = options.seed;
  for (const char c : sensor) seed = MixBits(seed + static_cast<unsigned char>(c));
  options.seed = static_cast<std::uint32_t>(seed);
  return options;
}

SimulationOptions OptionsOf(const SimulatedLidar& lidar, const RigSimulationOptions& rig) {
  SimulationOptions options = WithSeedOf(lidar.name, rig.world);
  options.scan = lidar.scan;
  return options;
}

// The camera simulator's lidar frame is the room's.
SimulationOptions OptionsOf(const SimulatedCamera& camera, const RigSimulationOptions& rig) {
  SimulationOptions options = WithSeedOf(camera.name, rig.world);
  options.T_camera_lidar = camera.T_camera_rig;
  return options;
}

StopChecks ChecksOf(const SimulatedLidar& lidar,
                    const SimulatedCamera& camera,
                    const RigSimulationOptions& rig,
                    const BoardSpec& board,
                    const Room& room) {
  SimulationOptions options = rig.world;
  options.scan = lidar.scan;
  options.T_camera_lidar = camera.T_camera_rig;
  return StopChecks(options, board, camera.model, room, lidar.T_rig_lidar);
}

// Of the lidars that share views with a camera.
std::vector<StopFinder> FindersOf(const SimulatedCamera& camera,
                                  const RigSimulationOptions& rig,
                                  const BoardSpec& board,
                                  const Room& room) {
  SimulationOptions options = rig.world;
  options.T_camera_lidar = camera.T_camera_rig;
  std::vector<StopFinder> finders;
  for (const SimulatedLidar& lidar : rig.lidars) {
    StopFinder finder(options, camera.model, ChecksOf(lidar, camera, rig, board, room));
    const KeyedNoise noise(options.seed, NoiseUse::kStops, -1);
    if (finder.FindAnywhere(noise)) finders.push_back(std::move(finder));
  }
  if (finders.empty()) {
    throw std::invalid_argument("no lidar sees the board where camera " + camera.name + " does");
  }
  return finders;
}

BoardScript ScriptOf(const RigSimulationOptions& rig, const BoardSpec& board, const Room& room) {
  std::vector<std::vector<StopFinder>> by_camera;
  for (const SimulatedCamera& camera : rig.cameras) {
    by_camera.push_back(FindersOf(camera, rig, board, room));
  }
  std::vector<StopFinder> turns;
  for (std::size_t turn = 0; turn < rig.lidars.size(); ++turn) {
    for (const auto& finders : by_camera) turns.push_back(finders[turn % finders.size()]);
  }
  std::vector<BoardPlace> stops = FindStops(rig.world, turns);
  for (std::size_t i = 1; i < stops.size(); ++i) {  // the shorter way round
    stops[i] = Unwound(stops[i], stops[i - 1][0]);
  }
  return BoardScript(rig.world, stops);
}

}  // namespace

std::vector<std::string> RigSimulationOptions::Problems() const {
  ProblemList problems;
  problems.Add(world.Problems());
  problems.Require(!lidars.empty(), "a rig needs lidars", lidars.size());
  problems.Require(!cameras.empty(), "a rig needs cameras", cameras.size());
  std::map<std::string, int> num_named;
  for (const SimulatedLidar& lidar : lidars) {
    ++num_named[lidar.name];
    problems.Add(lidar.scan.Problems(), lidar.name + ": ");
  }
  for (const SimulatedCamera& camera : cameras) {
    ++num_named[camera.name];
    problems.Add(camera.model.Problems(), camera.name + ": ");
  }
  for (const auto& [name, count] : num_named) {
    problems.Require(count == 1, "a sensor's name must be its own", name);
  }
  return problems.lines();
}

struct RigSimulation::Impl {
  Impl(const RigSimulationOptions& options_in, const BoardSpec& board_in)
      : options(options_in),
        board(board_in),
        room(ClutterOf(options.world, board)),
        script(ScriptOf(options, board, room)) {
    for (const SimulatedLidar& lidar : options.lidars) {
      lidars.emplace_back(OptionsOf(lidar, options), board, room, lidar.T_rig_lidar);
    }
  }

  StopChecks Checks(std::size_t lidar, std::size_t camera) const {
    return ChecksOf(options.lidars.at(lidar), options.cameras.at(camera), options, board, room);
  }

  RigSimulationOptions options;
  BoardSpec board;
  Room room;
  BoardScript script;
  std::vector<LidarSimulator> lidars;
  std::map<std::size_t, CameraSimulator> cameras;  // those that were asked for
};

RigSimulation::RigSimulation(const RigSimulationOptions& options, const BoardSpec& board) {
  RequireUsable("simulation of a rig", options.Problems());
  RequireUsable("board", BoardProblems(board));
  impl_ = std::make_unique<Impl>(options, board);
}

RigSimulation::~RigSimulation() = default;

double RigSimulation::DurationS() const { return impl_->script.DurationS(); }

Eigen::Isometry3d RigSimulation::T_rig_board(double time_s) const {
  return impl_->script.T_lidar_board(time_s);
}

bool RigSimulation::IsStill(double time_s) const { return impl_->script.IsStill(time_s); }

bool RigSimulation::LidarSees(std::size_t lidar, double time_s) const {
  return impl_->Checks(lidar, 0).LidarSees(T_rig_board(time_s));
}

bool RigSimulation::CameraSees(std::size_t camera, double time_s) const {
  return impl_->Checks(0, camera).CameraSees(T_rig_board(time_s));
}

PointCloud RigSimulation::Sweep(std::size_t lidar, double time_s) const {
  const Eigen::Isometry3d T_lidar_rig = impl_->options.lidars.at(lidar).T_rig_lidar.inverse();
  return impl_->lidars[lidar].Sweep(T_lidar_rig * T_rig_board(time_s), Microseconds(time_s));
}

cv::Mat RigSimulation::Image(std::size_t camera, double time_s) {
  auto painted = impl_->cameras.find(camera);
  if (painted == impl_->cameras.end()) {
    const SimulatedCamera& which = impl_->options.cameras.at(camera);
    painted =
        impl_->cameras
            .emplace(std::piecewise_construct,
                     std::forward_as_tuple(camera),
                     std::forward_as_tuple(
                         OptionsOf(which, impl_->options), impl_->board, which.model, impl_->room))
            .first;
  }
  return painted->second.Render(T_rig_board(time_s), Microseconds(time_s));
}

}  // namespace voqcal
