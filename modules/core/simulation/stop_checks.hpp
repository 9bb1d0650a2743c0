#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"
#include "core/simulation/room.hpp"
#include "core/simulation/simulation.hpp"

namespace voqcal {

/// Whether the board can rest somewhere: whole in the image and in the lidar's field of view,
/// facing both, hidden by nothing and clear of walls and furniture. All in the room's frame, which
/// is the lidar's unless that stands elsewhere.
class StopChecks {
 public:
  /// @param room  borrowed.
  /// @param T_room_lidar  where the lidar stands; the camera stands by options.T_camera_lidar in
  ///     the room's frame.
  StopChecks(const SimulationOptions& options,
             const BoardSpec& board,
             const CameraModel& camera,
             const Room& room,
             const Eigen::Isometry3d& T_room_lidar = Eigen::Isometry3d::Identity());

  bool IsGood(const Eigen::Isometry3d& T_room_board) const;

  /// Whole, facing it and unhidden.
  bool LidarSees(const Eigen::Isometry3d& T_room_board) const;
  bool CameraSees(const Eigen::Isometry3d& T_room_board) const;

 private:
  bool IsBetweenBeams(const std::vector<Eigen::Vector3d>& outline_m) const;
  bool IsInImage(const std::vector<Eigen::Vector3d>& outline_m) const;
  bool HasRoom(const Eigen::Isometry3d& T_room_board,
               const std::vector<Eigen::Vector3d>& outline_m) const;
  bool IsUnhidden(const Eigen::Vector3d& origin_m,
                  const std::vector<Eigen::Vector3d>& outline_m) const;
  std::vector<Eigen::Vector3d> OutlineOf(const Eigen::Isometry3d& T_room_board) const;

  SimulationOptions options_;
  BoardSpec board_;
  CameraModel camera_;
  const Room& room_;
  Eigen::Isometry3d T_room_lidar_;
  Eigen::Isometry3d T_room_camera_;
  std::vector<Eigen::Vector3d> outline_board_m_;
};

}  // namespace voqcal
