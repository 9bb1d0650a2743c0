#include "core/likelihood/lidar_bias.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <utility>

#include "core/lidar/plane_fit.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMinPlanePoints = 10;

// Where the ray to `point_m` meets the plane.
Eigen::Vector3d AlongItsRay(const Eigen::Vector3d& point_m, const PlaneFit& plane) {
  return point_m * plane.normal.dot(plane.point_m) / plane.normal.dot(point_m);
}

PlaneFit PlaneOf(const PointCloud& cloud_lidar_m) {
  constexpr double kScaleM = 0.03;  // mixed pixels lie farther off than three times the noise
  std::vector<Eigen::Vector3d> points_m;
  PointMoments moments;
  for (const LidarPoint& point : cloud_lidar_m.points) {
    points_m.push_back(point.position_m.cast<double>());
    moments.Add(points_m.back());
  }
  return FitPlaneRobustly(points_m, FitPlane(moments), kScaleM);
}

}  // namespace

std::string BiasEstimate::Text() const {
  if (!is_observable) return "unobservable";
  constexpr double kMillimetresPerMetre = 1000.0;
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(1);
  text << kMillimetresPerMetre * value_m << " +- " << kMillimetresPerMetre * standard_error_m
       << " mm";
  return text.str();
}

ShadeScale MakeShadeScale(const std::vector<const BoardSample*>& samples) {
  std::vector<float> intensities;
  for (const BoardSample* sample : samples) {
    if (!sample->lidar.points_lidar_m.has_intensity) continue;
    for (const LidarPoint& point : sample->lidar.points_lidar_m.points) {
      intensities.push_back(point.intensity);
    }
  }
  return ShadeScaleOf(std::move(intensities));
}

bool LidarBias::IsObservable() const {
  const auto is_observable = [](const BiasEstimate& estimate) { return estimate.is_observable; };
  return common.is_observable || dark_step.is_observable || outline_lift.is_observable ||
         outline_rise.is_observable || std::any_of(rings.begin(), rings.end(), is_observable);
}

double LidarBias::OffsetM(const LidarPoint& point, const PointCloud& cloud) const {
  const bool has_ring = cloud.has_ring && point.ring < rings.size();
  const double ring_m = has_ring ? rings[point.ring].value_m : 0.0;
  const double shade = cloud.has_intensity ? shades.ShadeOf(point.intensity) : 0.0;
  return common.value_m + dark_step.value_m * shade + ring_m;
}

PointCloud LidarBias::Corrected(const PointCloud& cloud_lidar_m) const {
  PointCloud corrected = cloud_lidar_m;
  for (LidarPoint& point : corrected.points) {
    const double range_m = point.position_m.cast<double>().norm();
    if (!(range_m > 0.0)) continue;  // a beam without a return
    point.position_m *= static_cast<float>((range_m - OffsetM(point, cloud_lidar_m)) / range_m);
  }
  return corrected;
}

BoardPose CorrectedPose(const LidarBoard& lidar, const LidarBias& bias) {
  if (lidar.points_lidar_m.points.size() < kMinPlanePoints) return lidar.pose;
  const PlaneFit plane = PlaneOf(bias.Corrected(lidar.points_lidar_m));
  BoardPose pose = lidar.pose;
  pose.normal = plane.normal;
  const double lift_m =
      bias.outline_lift.value_m + bias.outline_rise.value_m * lidar.pose.centre_m.norm();
  pose.centre_m = AlongItsRay(lidar.pose.centre_m - lift_m * Eigen::Vector3d::UnitZ(), plane);
  // The rays fix the outline's direction, the board its size.
  const Eigen::Isometry3d T_lidar_board = TransformFromPose(lidar.pose);
  const double step_m = 0.1;  // any: the direction of a line does not depend on its length
  const auto axis = [&](int i) -> Eigen::Vector3d {
    const Eigen::Vector3d along_m = step_m * T_lidar_board.linear().col(i);
    return AlongItsRay(lidar.pose.centre_m + along_m, plane) -
           AlongItsRay(lidar.pose.centre_m - along_m, plane);
  };
  Eigen::Matrix3d axes;
  axes << axis(0).normalized(), axis(1).normalized(), plane.normal;
  const Eigen::Matrix3d R_lidar_corrected = NearestRotation(axes);
  for (std::size_t i = 0; i < pose.corners_m.size(); ++i) {
    const Eigen::Vector3d corner_board_m = T_lidar_board.inverse() * lidar.pose.corners_m[i];
    pose.corners_m[i] = pose.centre_m + R_lidar_corrected * corner_board_m;
  }
  pose.normal = R_lidar_corrected.col(2);
  return pose;
}

}  // namespace voqcal
