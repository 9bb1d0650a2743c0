#include "core/simulation/board_path.hpp"

#include <algorithm>
#include <cmath>

namespace voqcal {
namespace {

// Board axes of one that faces the lidar upright.
Eigen::Matrix3d UprightAt(double azimuth_rad) {
  const Eigen::Vector3d level(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
  Eigen::Matrix3d R_lidar_upright;
  R_lidar_upright.col(2) = -level;
  R_lidar_upright.col(1) = Eigen::Vector3d::UnitZ();
  R_lidar_upright.col(0) = Eigen::Vector3d::UnitZ().cross(-level);
  return R_lidar_upright;
}

}  // namespace

Eigen::Isometry3d PoseOf(const BoardPlace& place) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const double azimuth = place[0];
  const double elevation = place[1];
  const Vector3d level(std::cos(azimuth), std::sin(azimuth), 0.0);
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  T_lidar_board.linear() = UprightAt(azimuth) * (AngleAxisd(place[3], Vector3d::UnitY()) *
                                                 AngleAxisd(place[4], Vector3d::UnitX()) *
                                                 AngleAxisd(place[5], Vector3d::UnitZ()))
                                                    .toRotationMatrix();
  T_lidar_board.translation() =
      place[2] * (std::cos(elevation) * level + std::sin(elevation) * Vector3d::UnitZ());
  return T_lidar_board;
}

BoardPlace PlaceOf(const Eigen::Isometry3d& T_lidar_board) {
  const Eigen::Vector3d centre_m = T_lidar_board.translation();
  BoardPlace place;
  place[0] = std::atan2(centre_m.y(), centre_m.x());
  place[1] = std::atan2(centre_m.z(), centre_m.head<2>().norm());
  place[2] = centre_m.norm();
  // R = R_y(yaw) R_x(pitch) R_z(roll): its last column is (cos p sin y, -sin p, cos p cos y), its
  // middle row (cos p sin r, cos p cos r, -sin p).
  const Eigen::Matrix3d R = UprightAt(place[0]).transpose() * T_lidar_board.linear();
  place[3] = std::atan2(R(0, 2), R(2, 2));
  place[4] = -std::asin(std::clamp(R(1, 2), -1.0, 1.0));
  place[5] = std::atan2(R(1, 0), R(1, 1));
  return place;
}

double ForwardAzimuthRad(const Eigen::Isometry3d& T_camera_lidar) {
  // The camera's z axis in the lidar frame: the last row of R_camera_lidar.
  return std::atan2(T_camera_lidar.linear()(2, 1), T_camera_lidar.linear()(2, 0));
}

BoardPlace Unwound(const BoardPlace& place, double forward_azimuth_rad) {
  BoardPlace unwound = place;
  unwound[0] = forward_azimuth_rad + std::remainder(place[0] - forward_azimuth_rad, 2.0 * M_PI);
  return unwound;
}

BoardPlace Between(const BoardPlace& from, const BoardPlace& to, double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  // 6t^5 - 15t^4 + 10t^3
  const double eased = t * t * t * (t * (6 * t - 15) + 10);
  return from + eased * (to - from);
}

}  // namespace voqcal
