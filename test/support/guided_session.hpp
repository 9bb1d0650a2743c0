#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/guidance/next_pose.hpp"
#include "core/lidar_detection/lidar_board.hpp"
#include "core/simulation/simulation.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal::test {

/// A session in an empty hall: sweeps through the lidar's detector, chessboard corners with noise.
struct GuidedSessionOptions {
  SimulationOptions simulation;  ///< The truth, and the lidar's faults.
  LidarBoardOptions lidar_board_detector;
  bool is_guided = true;  ///< Each pose is ProposeNextPose's; otherwise anywhere in view.
  double max_random_roll_rad = M_PI / 4;  ///< Of a random board from a diamond; 45 degrees: any.
  double place_error_m = 0.2;  ///< RMS distance of a guided board from where it is asked for...
  double turn_error_rad = 10.0 * M_PI / 180.0;  ///< ...and its RMS turn.
  double corner_noise_px = 0.1;                 ///< 1 sigma of each corner in each direction.
  int num_poses = 20;
  std::uint32_t seed = 1;
};

/// After so many poses as steps came before, and this one.
struct GuidedStep {
  int num_holds = 0;  ///< Of the board in both sensors' sight, those without a sample included.
  double predicted_error = 0.0;  ///< Worst in the scene, by the refined covariance; or infinite.
  double true_error = 0.0;       ///< Worst in the scene, in the tolerance's unit; or infinite.
};

/// A board held by a person who knows nothing: anywhere in the image, at any of the distances asked
/// of guided ones, tilted to 40 degrees each way, and turned about its normal from a diamond by up
/// to `max_roll_rad`. Nothing where it would be out of either sensor's view or slanted by more than
/// 55 degrees, as the simulated sessions' boards are.
std::optional<Eigen::Isometry3d> RandomHold(double max_roll_rad,
                                            const Eigen::Isometry3d& T_camera_lidar,
                                            const GuidedRig& rig,
                                            const GuidanceOptions& guidance,
                                            Random* random);

std::vector<GuidedStep> SimulateGuidedSession(const GuidedSessionOptions& options,
                                              const GuidedRig& rig,
                                              const GuidanceOptions& guidance);

/// The first number of poses from which on an error stays within the tolerance; steps + 1 if none.
int PosesNeeded(const std::vector<double>& errors, double tolerance);

}  // namespace voqcal::test
