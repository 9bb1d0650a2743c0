#include "core/simulation/room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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

Eigen::Vector3d NormalOf(const Tube& tube, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d axis = (tube.end_m - tube.begin_m).normalized();
  const Eigen::Vector3d from_begin_m = point_m - tube.begin_m;
  return (from_begin_m - axis.dot(from_begin_m) * axis).normalized();
}

Eigen::Vector3d NormalOf(const Panel& panel, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d normal = panel.T_lidar_panel.linear().col(2);
  return normal.dot(direction) > 0 ? Eigen::Vector3d(-normal) : normal;
}

int NumSolidsOf(const Props& props) {
  return static_cast<int>(props.boxes.size() + props.tubes.size() + props.panels.size());
}

std::vector<int> NumbersBelow(int count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

Material ShellMaterial(int axis, bool is_upper) {
  if (axis == 2) return is_upper ? Material::kCeiling : Material::kFloor;
  return axis == 0 && is_upper ? Material::kDoor : Material::kWall;
}

}  // namespace

Room::Room(const Props& props)
    : interior_(MakeBox(-4.0, kFrontXM, -4.0, 4.0, kFloorZM, kCeilingZM, Material::kWall)),
      shell_(
          MakeBox(-4.0, kFrontXM + kDoorDepthM, -4.0, 4.0, kFloorZM, kCeilingZM, Material::kWall)),
      num_surround_(kNumSurround),
      props_{MakeBoxes(), {}, {}} {
  props_.Append(props);
  all_solids_ = NumbersBelow(NumSolidsOf(props_));
}

Room::Room(const Box& hall, const Props& props)
    : interior_(hall), shell_(hall), props_(props), all_solids_(NumbersBelow(NumSolidsOf(props))) {}

RoomHit Room::Cast(const Eigen::Vector3d& origin_lidar_m,
                   const Eigen::Vector3d& direction_lidar) const {
  return Cast(origin_lidar_m, direction_lidar, all_solids_);
}

RoomHit Room::Cast(const Eigen::Vector3d& origin_lidar_m,
                   const Eigen::Vector3d& direction_lidar,
                   const std::vector<int>& solids) const {
  const int num_boxes = static_cast<int>(props_.boxes.size());
  const int num_tubes = static_cast<int>(props_.tubes.size());
  const Eigen::Vector3d inverse_direction = InverseDirection(direction_lidar);
  const Crossing shell = Cross(shell_, origin_lidar_m, inverse_direction);
  double range_m = shell.leave;
  int axis = shell.leave_axis;
  int first = -1;
  for (const int solid : solids) {
    if (solid < num_boxes) {
      const Crossing crossing = Cross(props_.boxes[solid], origin_lidar_m, inverse_direction);
      if (crossing.enter <= 0 || crossing.enter >= crossing.leave || crossing.enter >= range_m)
        continue;
      range_m = crossing.enter;
      axis = crossing.enter_axis;
    } else {
      const std::optional<double> met_m =
          solid < num_boxes + num_tubes
              ? props_.tubes[solid - num_boxes].Cast(origin_lidar_m, direction_lidar)
              : props_.panels[solid - num_boxes - num_tubes].Cast(origin_lidar_m, direction_lidar);
      if (!met_m || *met_m >= range_m) continue;
      range_m = *met_m;
    }
    first = solid;
  }
  RoomHit hit;
  hit.range_m = range_m;
  hit.point_lidar_m = origin_lidar_m + range_m * direction_lidar;
  if (first >= num_boxes) {
    hit.surface = 6 * (num_boxes + 1) + first - num_boxes;
    if (first < num_boxes + num_tubes) {
      const Tube& tube = props_.tubes[first - num_boxes];
      hit.material = tube.material;
      hit.normal_lidar = NormalOf(tube, hit.point_lidar_m);
    } else {
      const Panel& panel = props_.panels[first - num_boxes - num_tubes];
      hit.material = panel.material;
      hit.normal_lidar = NormalOf(panel, direction_lidar);
    }
    return hit;
  }
  const bool is_forward = direction_lidar[axis] > 0;
  hit.surface = 6 * (first + 1) + 2 * axis + (is_forward ? 1 : 0);
  hit.material = first < 0 ? ShellMaterial(axis, is_forward) : props_.boxes[first].material;
  hit.normal_lidar[axis] = is_forward ? -1.0 : 1.0;
  return hit;
}

std::vector<Bound> Room::Bounds() const {
  std::vector<Bound> bounds;
  for (const Box& box : props_.boxes) {
    bounds.push_back(
        {(box.min_lidar_m + box.max_lidar_m) / 2, (box.max_lidar_m - box.min_lidar_m).norm() / 2});
  }
  for (const Tube& tube : props_.tubes) {
    bounds.push_back(
        {(tube.begin_m + tube.end_m) / 2, (tube.end_m - tube.begin_m).norm() / 2 + tube.radius_m});
  }
  for (const Panel& panel : props_.panels) {
    bounds.push_back(
        {panel.T_lidar_panel.translation(), std::hypot(panel.width_m, panel.height_m) / 2});
  }
  return bounds;
}

double Room::DistanceToShellM(const Eigen::Vector3d& point_lidar_m) const {
  return std::min((point_lidar_m - interior_.min_lidar_m).minCoeff(),
                  (interior_.max_lidar_m - point_lidar_m).minCoeff());
}

double Room::DistanceToFurnitureM(const Eigen::Vector3d& point_lidar_m) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = num_surround_; i < props_.boxes.size(); ++i) {
    nearest_m = std::min(nearest_m, DistanceM(props_.boxes[i], point_lidar_m));
  }
  for (const Tube& tube : props_.tubes) {
    nearest_m = std::min(nearest_m, DistanceM(tube, point_lidar_m));
  }
  for (const Panel& panel : props_.panels) {
    nearest_m = std::min(nearest_m, DistanceM(panel, point_lidar_m));
  }
  return nearest_m;
}

}  // namespace voqcal
