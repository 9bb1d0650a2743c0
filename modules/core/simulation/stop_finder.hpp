#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/camera/camera_model.hpp"
#include "core/simulation/board_path.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/simulation.hpp"
#include "core/simulation/stop_checks.hpp"

namespace voqcal {

/// Picks stops of the board that are good (StopChecks) for one camera and one lidar.
class StopFinder {
 public:
  StopFinder(const SimulationOptions& options, const CameraModel& camera, StopChecks checks);

  /// A stop whose centre is seen in [column, column + share) of the image's width and whose
  /// distance is in the same way [distance, distance + share) of the distances, all within [0, 1].
  std::optional<BoardPlace> Find(const KeyedNoise& noise,
                                 int first_trial,
                                 int num_trials,
                                 double column,
                                 double distance,
                                 double share) const;

  /// A stop anywhere.
  std::optional<BoardPlace> FindAnywhere(const KeyedNoise& noise) const;

  const StopChecks& checks() const { return checks_; }

 private:
  std::optional<BoardPlace> Place(
      const KeyedNoise& noise, int trial, double column, double distance, double share) const;

  SimulationOptions options_;
  CameraModel camera_;
  StopChecks checks_;
  Eigen::Matrix3d R_lidar_camera_;
  double forward_azimuth_rad_;
};

/// options.num_poses stops, spread over images' widths and over the distances; finders take turns.
/// @throws std::invalid_argument if a finder finds no place for one.
std::vector<BoardPlace> FindStops(const SimulationOptions& options,
                                  const std::vector<StopFinder>& finders);

}  // namespace voqcal
