#include "core/simulation/props.hpp"

#include <algorithm>
#include <cmath>

namespace voqcal {

std::optional<double> Tube::Cast(const Eigen::Vector3d& origin_m,
                                 const Eigen::Vector3d& direction) const {
  // With a = end - begin and p(t) = origin - begin + t * direction, the surface is where the part
  // of p(t) across a has the length of the radius: |p|^2 |a|^2 - (p.a)^2 = r^2 |a|^2, a quadratic
  // in t.
  const Eigen::Vector3d axis = end_m - begin_m;
  const Eigen::Vector3d start = origin_m - begin_m;
  const double axis_axis = axis.squaredNorm();
  const double axis_direction = axis.dot(direction);
  const double axis_start = axis.dot(start);
  const double a = axis_axis - axis_direction * axis_direction;
  const double b = axis_axis * start.dot(direction) - axis_start * axis_direction;
  const double c =
      axis_axis * (start.squaredNorm() - radius_m * radius_m) - axis_start * axis_start;
  const double discriminant = b * b - a * c;
  if (discriminant < 0 || a <= 0) return std::nullopt;
  const double range_m = (-b - std::sqrt(discriminant)) / a;
  const double along = axis_start + range_m * axis_direction;
  if (range_m <= 0 || along < 0 || along > axis_axis) return std::nullopt;
  return range_m;
}

std::optional<double> Panel::Cast(const Eigen::Vector3d& origin_m,
                                  const Eigen::Vector3d& direction) const {
  const auto R_lidar_panel = T_lidar_panel.linear();
  const Eigen::Vector3d to_centre_m = T_lidar_panel.translation() - origin_m;
  const double range_m =
      R_lidar_panel.col(2).dot(to_centre_m) / R_lidar_panel.col(2).dot(direction);
  if (!(range_m > 0) || std::isinf(range_m)) return std::nullopt;  // behind it or along it
  const Eigen::Vector3d offset_m = range_m * direction - to_centre_m;
  if (std::abs(R_lidar_panel.col(0).dot(offset_m)) > width_m / 2 ||
      std::abs(R_lidar_panel.col(1).dot(offset_m)) > height_m / 2) {
    return std::nullopt;
  }
  return range_m;
}

void Props::Append(const Props& others) {
  boxes.insert(boxes.end(), others.boxes.begin(), others.boxes.end());
  tubes.insert(tubes.end(), others.tubes.begin(), others.tubes.end());
  panels.insert(panels.end(), others.panels.begin(), others.panels.end());
}

double DistanceM(const Box& box, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d outside_m =
      (box.min_lidar_m - point_m).cwiseMax(point_m - box.max_lidar_m).cwiseMax(0.0);
  return outside_m.norm();
}

double DistanceM(const Tube& tube, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d axis_m = tube.end_m - tube.begin_m;
  const double share = axis_m.dot(point_m - tube.begin_m) / axis_m.squaredNorm();
  const Eigen::Vector3d foot_m = tube.begin_m + std::clamp(share, 0.0, 1.0) * axis_m;
  return std::max(0.0, (point_m - foot_m).norm() - tube.radius_m);
}

double DistanceM(const Panel& panel, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d point_panel_m = panel.T_lidar_panel.inverse() * point_m;
  const Eigen::Vector3d half_m(panel.width_m / 2, panel.height_m / 2, 0.0);
  return (point_panel_m.cwiseAbs() - half_m).cwiseMax(0.0).norm();
}

}  // namespace voqcal
