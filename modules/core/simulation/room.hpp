#pragma once

#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// What a surface of the room is made of; decides its texture.
enum class Material { kFloor, kCeiling, kWall, kDoor, kPillar, kTable, kCrate, kCupboard };

/// An axis-aligned box in the lidar frame.
struct Box {
  Eigen::Vector3d min_lidar_m;
  Eigen::Vector3d max_lidar_m;
  Material material = Material::kCrate;
};

/// Where a ray meets the room.
struct RoomHit {
  double range_m = 0.0;
  int surface = 0;  ///< Tells the room's faces apart: the same number is the same flat face.
  Material material = Material::kWall;
  Eigen::Vector3d point_lidar_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_lidar = Eigen::Vector3d::Zero();  ///< Unit length, into the room.
};

/// What does not move: a closed hall of 10 x 8 x 3 m around the lidar, with furniture. All surfaces
/// are faces of axis-aligned boxes in the lidar frame.
class Room {
 public:
  Room();

  /// The first surface along a ray from inside the room; there always is one.
  RoomHit Cast(const Eigen::Vector3d& origin_lidar_m, const Eigen::Vector3d& direction_lidar) const;

  /// How far a point is inside the walls, floor and ceiling; negative outside.
  double DistanceToShellM(const Eigen::Vector3d& point_lidar_m) const;

  /// How far a point is from the nearest furniture; zero inside of it.
  double DistanceToFurnitureM(const Eigen::Vector3d& point_lidar_m) const;

  double FloorZM() const { return interior_.min_lidar_m.z(); }

 private:
  Box interior_;            ///< Free space between the walls.
  Box shell_;               ///< The same, deeper behind the door.
  std::vector<Box> boxes_;  ///< Door surround first, then furniture.
};

/// Share of the light that a spot of the room sends back: blue, green, red, each in [0, 1].
Eigen::Vector3f RoomAlbedo(const RoomHit& hit);

}  // namespace voqcal
