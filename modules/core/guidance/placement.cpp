#include "core/guidance/placement.hpp"

#include <algorithm>
#include <cmath>

#include "core/board/board_sample.hpp"
#include "core/geometry/rigid.hpp"
#include "core/problems.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

// Board axes of one that faces the camera upright: x to the right in the image, y up.
Eigen::Matrix3d FacingCamera(const Eigen::Vector3d& centre_camera_m,
                             const Eigen::Vector3d& up_camera) {
  Eigen::Matrix3d R_camera_facing;
  R_camera_facing.col(2) = -centre_camera_m.normalized();
  R_camera_facing.col(0) = up_camera.cross(R_camera_facing.col(2)).normalized();
  R_camera_facing.col(1) = R_camera_facing.col(2).cross(R_camera_facing.col(0));
  return R_camera_facing;
}

// Facing the camera, to tilted: R_y(yaw) R_x(pitch).
Eigen::Matrix3d Tilt(const Placement& placement) {
  return (Eigen::AngleAxisd(placement.yaw_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(placement.pitch_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

bool IsFacing(const Eigen::Vector3d& centre_m, const Eigen::Vector3d& normal, double max_rad) {
  return AngleBetween(normal, -centre_m) <= max_rad;
}

bool IsInImage(const BoardPose& pose_camera, const CameraModel& camera, double margin) {
  const double margin_px = margin * std::min(camera.width_px, camera.height_px);
  return std::all_of(
      pose_camera.corners_m.begin(), pose_camera.corners_m.end(), [&](const auto& corner_m) {
        if (!camera.IsInFront(corner_m)) return false;
        const Eigen::Vector2d pixel_px = camera.Project(Eigen::Vector3d(corner_m));
        return pixel_px.minCoeff() >= margin_px &&
               pixel_px.x() <= camera.width_px - 1 - margin_px &&
               pixel_px.y() <= camera.height_px - 1 - margin_px;
      });
}

// The shortest of the squares around the pattern's centre is about the image's.
double SquarePx(const Eigen::Isometry3d& T_camera_board,
                const BoardSpec& board,
                const CameraModel& camera) {
  const auto pixel = [&](double x_m, double y_m) -> Eigen::Vector2d {
    return camera.Project(Eigen::Vector3d(T_camera_board * Eigen::Vector3d(x_m, y_m, 0.0)));
  };
  const double half_m = board.square_m / 2;
  return std::min((pixel(half_m, 0.0) - pixel(-half_m, 0.0)).norm(),
                  (pixel(0.0, half_m) - pixel(0.0, -half_m)).norm());
}

bool IsInFieldOfView(const BoardPose& pose_lidar, const SensorExpectation& expectation) {
  return std::all_of(
      pose_lidar.corners_m.begin(), pose_lidar.corners_m.end(), [&](const Eigen::Vector3d& corner) {
        const double elevation_rad = std::atan2(corner.z(), corner.head<2>().norm());
        return elevation_rad >= expectation.min_elevation_rad &&
               elevation_rad <= expectation.max_elevation_rad &&
               std::abs(std::atan2(corner.y(), corner.x())) <= expectation.max_azimuth_rad;
      });
}

}  // namespace

std::vector<std::string> PlacementLimits::Problems() const {
  ProblemList problems;
  problems.RequirePositive("min_distance_m", min_distance_m);
  problems.Require(max_distance_m >= min_distance_m && std::isfinite(max_distance_m),
                   "max_distance_m must be at least min_distance_m",
                   max_distance_m);
  problems.Require(max_incidence_rad > 0.0 && max_incidence_rad < M_PI / 2,
                   "max_incidence_deg must be within 0 and 90",
                   kDegPerRad * max_incidence_rad);
  problems.Require(image_margin >= 0.0 && image_margin < 0.5,
                   "image_margin must be within 0 and 0.5",
                   image_margin);
  problems.Require(min_square_px >= 0.0, "min_square_px must not be negative", min_square_px);
  problems.Require(min_rows >= 0, "min_rows must not be negative", min_rows);
  return problems.lines();
}

std::optional<Eigen::Isometry3d> PoseOf(const Placement& placement,
                                        const CameraModel& camera,
                                        const Eigen::Vector3d& up_camera) {
  constexpr double kLeastAngleRad = 10.0 * M_PI / 180.0;
  const auto ray = camera.Unproject(placement.centre_px);
  if (!ray) return std::nullopt;
  const double sine = up_camera.normalized().cross(ray->normalized()).norm();
  if (sine < std::sin(kLeastAngleRad)) return std::nullopt;
  Eigen::Isometry3d T_camera_board = Eigen::Isometry3d::Identity();
  T_camera_board.translation() = placement.distance_m * *ray;
  T_camera_board.linear() =
      FacingCamera(*ray, up_camera) * Tilt(placement) *
      Eigen::AngleAxisd(placement.turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T_camera_board;
}

Placement PlacementOf(const Eigen::Isometry3d& T_camera_board,
                      const CameraModel& camera,
                      const Eigen::Vector3d& up_camera) {
  const Eigen::Vector3d centre_m = T_camera_board.translation();
  const Eigen::Matrix3d R_facing_board =
      FacingCamera(centre_m, up_camera).transpose() * T_camera_board.linear();
  const Eigen::Vector3d normal = R_facing_board.col(2);
  Placement placement;
  placement.centre_px = camera.Project(centre_m);
  placement.distance_m = centre_m.norm();
  // R_y(yaw) R_x(pitch) z = (cos(pitch) sin(yaw), -sin(pitch), cos(pitch) cos(yaw))
  placement.yaw_rad = std::atan2(normal.x(), normal.z());
  placement.pitch_rad = -std::asin(std::clamp(normal.y(), -1.0, 1.0));
  const Eigen::Vector3d x_untilted = Tilt(placement).transpose() * R_facing_board.col(0);
  placement.turn_rad = std::atan2(x_untilted.y(), x_untilted.x());
  return placement;
}

bool IsInView(const Eigen::Isometry3d& T_camera_board,
              const Eigen::Isometry3d& T_camera_lidar,
              const BoardSpec& board,
              const CameraModel& camera,
              const SensorExpectation& expectation,
              const PlacementLimits& limits) {
  const BoardPose in_camera = PoseFromTransform(T_camera_board, board);
  const BoardPose in_lidar = PoseFromTransform(T_camera_lidar.inverse() * T_camera_board, board);
  const double distance_m = in_camera.centre_m.norm();
  return distance_m >= limits.min_distance_m && distance_m <= limits.max_distance_m &&
         IsFacing(in_camera.centre_m, in_camera.normal, limits.max_incidence_rad) &&
         IsFacing(in_lidar.centre_m, in_lidar.normal, limits.max_incidence_rad) &&
         IsInFieldOfView(in_lidar, expectation) &&
         IsInImage(in_camera, camera, limits.image_margin) &&
         SquarePx(T_camera_board, board, camera) >= limits.min_square_px;
}

}  // namespace voqcal
