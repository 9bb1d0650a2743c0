#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/simulation/props.hpp"

namespace voqcal {

/// Where a ray meets the room.
struct RoomHit {
  double range_m = 0.0;
  int surface = 0;  ///< Tells the room's faces apart: the same number is the same flat face.
  Material material = Material::kWall;
  Eigen::Vector3d point_lidar_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_lidar = Eigen::Vector3d::Zero();  ///< Unit length, into the room.
};

/// A ball around a solid.
struct Bound {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// What does not move: a closed hall around the lidar, with what stands in it. Walls, floor and
/// ceiling are faces of an axis-aligned box in the lidar frame.
class Room {
 public:
  /// A hall of 10 x 8 x 3 m with a door in its front wall, pillars and furniture; `props` stand in
  /// it as well.
  explicit Room(const Props& props = {});

  /// A hall that is empty but for `props`.
  Room(const Box& hall, const Props& props);

  /// The first surface along a ray from inside the room; there always is one.
  RoomHit Cast(const Eigen::Vector3d& origin_lidar_m, const Eigen::Vector3d& direction_lidar) const;

  /// The same, as if of the solids only these were there (in ascending order).
  RoomHit Cast(const Eigen::Vector3d& origin_lidar_m,
               const Eigen::Vector3d& direction_lidar,
               const std::vector<int>& solids) const;

  /// What stands in the room, one ball around each solid; the index is the solid's number.
  std::vector<Bound> Bounds() const;

  /// How far a point is inside the walls, floor and ceiling; negative outside.
  double DistanceToShellM(const Eigen::Vector3d& point_lidar_m) const;

  /// How far a point is from the nearest thing in the room; zero inside of it.
  double DistanceToFurnitureM(const Eigen::Vector3d& point_lidar_m) const;

  double FloorZM() const { return interior_.min_lidar_m.z(); }
  const Box& Interior() const { return interior_; }  ///< Free space between the walls.

 private:
  Box interior_;
  Box shell_;             ///< The same, deeper behind the door.
  int num_surround_ = 0;  ///< Boxes that are the wall around the door: the first.
  Props props_;
  std::vector<int> all_solids_;  ///< 0, 1, ...: boxes, then tubes, then panels.
};

/// Share of the light that a spot of the room sends back: blue, green, red, each in [0, 1].
Eigen::Vector3f RoomAlbedo(const RoomHit& hit);

}  // namespace voqcal
