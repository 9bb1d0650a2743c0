#include "core/simulation/room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voqcal {
namespace {

constexpr double kFloorZM = -1.2;
constexpr double kCeilingZM = 1.8;
constexpr double kFrontXM = 6.0;
constexpr double kDoorDepthM = 0.25;
constexpr int kNumSurround = 3;  // boxes that form the front wall around the door

Box MakeBox(double x0, double x1, double y0, double y1, double z0, double z1, Material material) {
  return {Eigen::Vector3d(x0, y0, z0), Eigen::Vector3d(x1, y1, z1), material};
}

std::vector<Box> MakeBoxes() {
  constexpr double kBackX = kFrontXM + kDoorDepthM;
  return {
      MakeBox(kFrontXM, kBackX, -4.0, -2.3, kFloorZM, kCeilingZM, Material::kWall),
      MakeBox(kFrontXM, kBackX, -1.3, 4.0, kFloorZM, kCeilingZM, Material::kWall),
      MakeBox(kFrontXM, kBackX, -2.3, -1.3, 0.9, kCeilingZM, Material::kWall),
      // Furniture: pillars, table with its legs and a carton, crates, cupboards along the walls.
      MakeBox(5.3, 5.7, 2.5, 2.9, kFloorZM, kCeilingZM, Material::kPillar),
      MakeBox(4.8, 5.2, -3.5, -3.1, kFloorZM, kCeilingZM, Material::kPillar),
      MakeBox(-2.4, -2.0, 2.3, 2.7, kFloorZM, kCeilingZM, Material::kPillar),
      MakeBox(5.1, 5.8, 0.3, 1.7, -0.50, -0.45, Material::kTable),
      MakeBox(5.15, 5.2, 0.35, 0.4, kFloorZM, -0.50, Material::kTable),
      MakeBox(5.15, 5.2, 1.6, 1.65, kFloorZM, -0.50, Material::kTable),
      MakeBox(5.7, 5.75, 0.35, 0.4, kFloorZM, -0.50, Material::kTable),
      MakeBox(5.7, 5.75, 1.6, 1.65, kFloorZM, -0.50, Material::kTable),
      MakeBox(5.3, 5.6, 0.7, 1.1, -0.45, -0.15, Material::kCrate),
      MakeBox(5.4, 5.9, -1.0, -0.4, kFloorZM, -0.7, Material::kCrate),
      MakeBox(2.0, 3.2, 3.55, 4.0, kFloorZM, 0.7, Material::kCupboard),
      MakeBox(1.2, 2.4, -4.0, -3.6, kFloorZM, 0.3, Material::kCupboard),
      MakeBox(-3.8, -3.0, -2.0, -1.0, kFloorZM, -0.4, Material::kCrate),
  };
}

// Distances along a ray at which it enters and leaves a box (the slab method), with the axes
// crossed.
struct Crossing {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int enter_axis = 0;
  int leave_axis = 0;
};

Crossing Cross(const Box& box,
               const Eigen::Vector3d& origin,
               const Eigen::Vector3d& inverse_direction) {
  Crossing crossing;
  for (int axis = 0; axis < 3; ++axis) {
    double near = (box.min_lidar_m[axis] - origin[axis]) * inverse_direction[axis];
    double far = (box.max_lidar_m[axis] - origin[axis]) * inverse_direction[axis];
    if (near > far) std::swap(near, far);
    if (near > crossing.enter) {
      crossing.enter = near;
      crossing.enter_axis = axis;
    }
    if (far < crossing.leave) {
      crossing.leave = far;
      crossing.leave_axis = axis;
    }
  }
  return crossing;
}

// A ray along an axis would give 0 * infinity in the slab method.
Eigen::Vector3d InverseDirection(const Eigen::Vector3d& direction) {
  constexpr double kTiny = 1e-12;
  return direction.unaryExpr(
      [](double d) { return 1.0 / (std::abs(d) < kTiny ? std::copysign(kTiny, d) : d); });
}

Material ShellMaterial(int axis, bool is_upper) {
  if (axis == 2) return is_upper ? Material::kCeiling : Material::kFloor;
  return axis == 0 && is_upper ? Material::kDoor : Material::kWall;
}

}  // namespace

Room::Room()
    : interior_(MakeBox(-4.0, kFrontXM, -4.0, 4.0, kFloorZM, kCeilingZM, Material::kWall)),
      shell_(
          MakeBox(-4.0, kFrontXM + kDoorDepthM, -4.0, 4.0, kFloorZM, kCeilingZM, Material::kWall)),
      boxes_(MakeBoxes()) {}

RoomHit Room::Cast(const Eigen::Vector3d& origin_lidar_m,
                   const Eigen::Vector3d& direction_lidar) const {
  const Eigen::Vector3d inverse_direction = InverseDirection(direction_lidar);
  const Crossing shell = Cross(shell_, origin_lidar_m, inverse_direction);
  double range_m = shell.leave;
  int axis = shell.leave_axis;
  int box = -1;
  for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) {
    const Crossing crossing = Cross(boxes_[i], origin_lidar_m, inverse_direction);
    if (crossing.enter <= 0 || crossing.enter >= crossing.leave || crossing.enter >= range_m)
      continue;
    range_m = crossing.enter;
    axis = crossing.enter_axis;
    box = i;
  }
  const bool is_forward = direction_lidar[axis] > 0;
  RoomHit hit;
  hit.range_m = range_m;
  hit.surface = 6 * (box + 1) + 2 * axis + (is_forward ? 1 : 0);
  hit.material = box < 0 ? ShellMaterial(axis, is_forward) : boxes_[box].material;
  hit.point_lidar_m = origin_lidar_m + range_m * direction_lidar;
  hit.normal_lidar[axis] = is_forward ? -1.0 : 1.0;
  return hit;
}

double Room::DistanceToShellM(const Eigen::Vector3d& point_lidar_m) const {
  return std::min((point_lidar_m - interior_.min_lidar_m).minCoeff(),
                  (interior_.max_lidar_m - point_lidar_m).minCoeff());
}

double Room::DistanceToFurnitureM(const Eigen::Vector3d& point_lidar_m) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = kNumSurround; i < boxes_.size(); ++i) {
    const Eigen::Vector3d outside_m = (boxes_[i].min_lidar_m - point_lidar_m)
                                          .cwiseMax(point_lidar_m - boxes_[i].max_lidar_m)
                                          .cwiseMax(0.0);
    nearest_m = std::min(nearest_m, outside_m.norm());
  }
  return nearest_m;
}

}  // namespace voqcal
