#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/lidar/point_cloud.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// The simulation of `rig` with the faults of a real VLP-16: all ranges 20 mm long, dark squares
/// 15 mm longer than bright ones, rings apart by up to about 30 mm (1 sigma 8 mm).
SimulationOptions FaultySimulation(const Rig& rig, int num_poses, std::uint32_t seed);

/// The samples that the detectors find in one image and one sweep of each stop, and that agree with
/// one another.
std::vector<BoardSample> SimulateSession(const Rig& rig, const SimulationOptions& simulation);

/// What is not as the estimators take it, at each stop of a simulated session.
struct SpoiltWorld {
  /// Of the sweep, before the detector has it.
  std::function<void(const Eigen::Isometry3d& T_lidar_board, PointCloud* sweep)> sweep;
  /// Of a chessboard corner, board frame.
  std::function<void(Eigen::Vector3d* corner_board_m)> corner;
  /// Where the camera sees the board, of where it is; by stop.
  std::function<Eigen::Isometry3d(int stop)> T_seen_true;
};

/// Sweeps through the detector, corners by projection with noise of 0.1 px (an image takes a
/// second): the samples that the lidar finds, their boards not yet seen (SeeBoardsAgain).
std::vector<BoardSample> SimulateProjected(const Rig& rig,
                                           const SimulationOptions& simulation,
                                           const SpoiltWorld& spoilt);

}  // namespace voqcal
