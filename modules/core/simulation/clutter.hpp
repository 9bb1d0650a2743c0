#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/simulation/props.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal {

/// What stands about beside the board.
struct ClutterOptions {
  int num_people = 3;
  int num_tripods = 2;
  int num_doors = 2;      ///< Door leaves that stand open.
  int num_furniture = 4;  ///< Crates, cupboards, tables.
  /// A second board on a stand, wider and higher than the true one by this factor; 0: there is
  /// none.
  double second_board_scale = 0.0;
  double min_distance_m = 1.2;  ///< Of everything from the lidar.
};

/// Draws people, tripods, doors, furniture and a second board, anywhere on a hall's floor. The same
/// seed gives the same things.
Props DrawClutter(const ClutterOptions& options,
                  const BoardSpec& board,
                  const Box& hall,
                  std::uint32_t seed);

/// What a simulation's options ask for, in the hall that it is in.
Props ClutterOf(const SimulationOptions& options, const BoardSpec& board);

/// A person who stands there upright: legs, trunk, arms and head; `azimuth_rad` is where they look.
Props Person(const Eigen::Vector3d& feet_m, double azimuth_rad);

}  // namespace voqcal
