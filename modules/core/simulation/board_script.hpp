#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/simulation/board_path.hpp"
#include "core/simulation/room.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal {

/// Where the board is at which time: a list of stops, and smooth moves between them.
///
/// Stops are spread over the camera's width and over the distances, and each is good (StopChecks).
class BoardScript {
 public:
  /// @throws std::invalid_argument if no place in the room satisfies all this.
  BoardScript(const SimulationOptions& options,
              const BoardSpec& board,
              const CameraModel& camera,
              const Room& room);

  /// @param stops  at least one.
  BoardScript(const SimulationOptions& options, std::vector<BoardPlace> stops);

  double DurationS() const;
  Eigen::Isometry3d T_lidar_board(double time_s) const;  // NOLINT: named for its frames
  bool IsStill(double time_s) const;

 private:
  struct Phase {
    int stop = 0;           ///< The latest stop that was reached.
    double moving_s = 0.0;  ///< Since the board left it; 0 while it rests there.
  };
  Phase PhaseAt(double time_s) const;

  double hold_s_;
  double move_s_;
  std::vector<BoardPlace> stops_;
};

}  // namespace voqcal
