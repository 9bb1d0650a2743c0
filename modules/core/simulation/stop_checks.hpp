#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/simulation/room.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal {

/// Whether the board can rest somewhere: whole in the image and in the lidar's field of view,
/// facing both, hidden by nothing and clear of walls and furniture.
class StopChecks {
 public:
  /// @param room  borrowed.
  StopChecks(const SimulationOptions& options,
             const BoardSpec& board,
             const CameraModel& camera,
             const Room& room);

  bool IsGood(const Eigen::Isometry3d& T_lidar_board) const;

 private:
  bool IsBetweenBeams(const std::vector<Eigen::Vector3d>& outline_m) const;
  bool IsInImage(const std::vector<Eigen::Vector3d>& outline_m) const;
  bool IsFacing(const Eigen::Isometry3d& T_lidar_board) const;
  bool HasRoom(const Eigen::Isometry3d& T_lidar_board,
               const std::vector<Eigen::Vector3d>& outline_m) const;
  bool IsUnhidden(const std::vector<Eigen::Vector3d>& outline_m) const;

  SimulationOptions options_;
  BoardSpec board_;
  CameraModel camera_;
  const Room& room_;
  Eigen::Isometry3d T_lidar_camera_;
  std::vector<Eigen::Vector3d> outline_board_m_;
};

}  // namespace voqcal
