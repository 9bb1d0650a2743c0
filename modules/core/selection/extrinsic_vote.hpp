#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_sample.hpp"
#include "core/camera/camera_model.hpp"
#include "core/geometry/rigid.hpp"

namespace voqcal {

/// An extrinsic that is good enough to say where in a sweep the camera's board is.
struct RoughExtrinsic {
  /// Takes lidar coordinates to camera coordinates: p_camera = T_camera_lidar * p_lidar.
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< Of [rotation_rad; translation_m], left side.
  int num_agreeing = 0;                    ///< Stops that have a candidate where it says.
};

/// Lets stops of the board vote for the extrinsic, each with whatever in the lidar's sight may be
/// the board: `lidar` and `runners_up`. One candidate whose sides fix its pose
/// makes an extrinsic; the other stops agree with it if one of theirs lies where it says, by the
/// covariances of both. The extrinsic with most votes wins: walls, doors and furniture agree with
/// none, since they do not move as the camera's board does. Turns of the board that its outline
/// does not tell apart are extrinsics of their own.
///
/// @param num_sure  the first so many stops are samples: the lidar alone was sure of them.
/// @param guess  one more extrinsic to vote on, if there is one; right within some 5 degrees, 0.2
/// m.
/// @return nothing if fewer than four stops agree; three are enough if all are sure, two for a
/// guess.
std::optional<RoughExtrinsic> VoteForExtrinsic(const std::vector<BoardSample>& stops,
                                               std::size_t num_sure,
                                               const CameraModel& camera,
                                               const std::optional<Eigen::Isometry3d>& guess = {});

/// Where the lidar will see the camera's board by the extrinsic, as T_lidar_board.
struct ExpectedBoard {
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  /// Of [rotation_rad; translation_m], perturbed on the left (lidar) side at the board's centre.
  Matrix6d covariance = Matrix6d::Zero();
};
ExpectedBoard ExpectBoard(const BoardPose& pose_camera, const RoughExtrinsic& extrinsic);

}  // namespace voqcal
