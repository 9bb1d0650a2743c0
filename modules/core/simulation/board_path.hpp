#pragma once

#include <Eigen/Geometry>

namespace voqcal {

/// One place of the board, by the six numbers in which its moves are even:
/// [azimuth, elevation (rad), distance (m) of its centre from the lidar; yaw, pitch, roll (rad)
/// from facing the lidar upright].
using BoardPlace = Eigen::Matrix<double, 6, 1>;

Eigen::Isometry3d PoseOf(const BoardPlace& place);
BoardPlace PlaceOf(const Eigen::Isometry3d& T_lidar_board);

/// Where the camera looks, seen by the lidar.
double ForwardAzimuthRad(const Eigen::Isometry3d& T_camera_lidar);

/// The same place with its azimuth within half a turn of `forward_azimuth_rad`: moves between such
/// places never pass behind the camera.
BoardPlace Unwound(const BoardPlace& place, double forward_azimuth_rad);

/// On the way between two places; `share` of the time has passed. Begins and ends without speed and
/// acceleration.
BoardPlace Between(const BoardPlace& from, const BoardPlace& to, double share);

}  // namespace voqcal
