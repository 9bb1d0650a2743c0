#include "core/simulation/stop_checks.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/rigid.hpp"
#include "core/simulation/board_prop.hpp"
#include "core/simulation/scan_pattern.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kMaxObliqueRad = 55 * kRadPerDeg;  // normal against the line of sight
constexpr double kBeamMarginRad = 0.25 * kRadPerDeg;
constexpr double kImageMarginShare = 0.02;  // of the shorter side
constexpr double kShellClearanceM = 0.2;
constexpr int kNumPerEdge = 6;  // outline points that are checked

bool IsFacing(const Eigen::Vector3d& sensor_m, const Eigen::Isometry3d& T_room_board) {
  return AngleBetween(T_room_board.linear().col(2), sensor_m - T_room_board.translation()) <
         kMaxObliqueRad;
}

}  // namespace

StopChecks::StopChecks(const SimulationOptions& options,
                       const BoardSpec& board,
                       const CameraModel& camera,
                       const Room& room,
                       const Eigen::Isometry3d& T_room_lidar)
    : options_(options),
      board_(board),
      camera_(camera),
      room_(room),
      T_room_lidar_(T_room_lidar),
      T_room_camera_(options.T_camera_lidar.inverse()),
      outline_board_m_(OutlinePointsBoardM(board, kNumPerEdge)) {}

bool StopChecks::IsGood(const Eigen::Isometry3d& T_room_board) const {
  const auto outline_m = OutlineOf(T_room_board);
  const Eigen::Vector3d lidar_m = T_room_lidar_.translation();
  const Eigen::Vector3d camera_m = T_room_camera_.translation();
  return IsBetweenBeams(outline_m) && IsInImage(outline_m) && IsFacing(lidar_m, T_room_board) &&
         IsFacing(camera_m, T_room_board) && HasRoom(T_room_board, outline_m) &&
         IsUnhidden(lidar_m, outline_m) && IsUnhidden(camera_m, outline_m);
}

bool StopChecks::LidarSees(const Eigen::Isometry3d& T_room_board) const {
  const auto outline_m = OutlineOf(T_room_board);
  const Eigen::Vector3d lidar_m = T_room_lidar_.translation();
  return IsBetweenBeams(outline_m) && IsFacing(lidar_m, T_room_board) &&
         IsUnhidden(lidar_m, outline_m);
}

bool StopChecks::CameraSees(const Eigen::Isometry3d& T_room_board) const {
  const auto outline_m = OutlineOf(T_room_board);
  const Eigen::Vector3d camera_m = T_room_camera_.translation();
  return IsInImage(outline_m) && IsFacing(camera_m, T_room_board) &&
         IsUnhidden(camera_m, outline_m);
}

std::vector<Eigen::Vector3d> StopChecks::OutlineOf(const Eigen::Isometry3d& T_room_board) const {
  std::vector<Eigen::Vector3d> outline_m;
  for (const auto& point : outline_board_m_) outline_m.push_back(T_room_board * point);
  return outline_m;
}

bool StopChecks::IsBetweenBeams(const std::vector<Eigen::Vector3d>& outline_m) const {
  const Eigen::Isometry3d T_lidar_room = T_room_lidar_.inverse();
  return std::all_of(outline_m.begin(), outline_m.end(), [&](const Eigen::Vector3d& point) {
    return IsInFieldOfView(options_.scan.pattern, T_lidar_room * point, kBeamMarginRad);
  });
}

bool StopChecks::IsInImage(const std::vector<Eigen::Vector3d>& outline_m) const {
  const double margin_px = kImageMarginShare * std::min(camera_.width_px, camera_.height_px);
  return std::all_of(outline_m.begin(), outline_m.end(), [&](const auto& point) {
    const Eigen::Vector3d point_camera_m = options_.T_camera_lidar * point;
    if (!camera_.IsInFront(point_camera_m)) return false;
    const Eigen::Vector2d pixel = camera_.Project(point_camera_m);
    return pixel.minCoeff() > margin_px && pixel.x() < camera_.width_px - 1 - margin_px &&
           pixel.y() < camera_.height_px - 1 - margin_px;
  });
}

bool StopChecks::HasRoom(const Eigen::Isometry3d& T_room_board,
                         const std::vector<Eigen::Vector3d>& outline_m) const {
  const double half_diagonal_m = std::hypot(board_.width_m, board_.height_m) / 2;
  if (room_.DistanceToFurnitureM(T_room_board.translation()) < half_diagonal_m) return false;
  const auto tubes = StandTubes(T_room_board, board_, room_.FloorZM());
  for (const Tube& tube : tubes) {
    Eigen::Vector3d end_m = tube.end_m;
    if (room_.DistanceToFurnitureM(end_m) < kShellClearanceM) return false;
    end_m.z() = 0.0;  // the stand does stand on the floor
    if (room_.DistanceToShellM(end_m) < kShellClearanceM) return false;
  }
  return std::all_of(outline_m.begin(), outline_m.end(), [&](const auto& point) {
    return room_.DistanceToShellM(point) > kShellClearanceM;
  });
}

bool StopChecks::IsUnhidden(const Eigen::Vector3d& origin_m,
                            const std::vector<Eigen::Vector3d>& outline_m) const {
  return std::all_of(outline_m.begin(), outline_m.end(), [&](const Eigen::Vector3d& point) {
    const double range_m = (point - origin_m).norm();
    return room_.Cast(origin_m, (point - origin_m) / range_m).range_m >= range_m;
  });
}

}  // namespace voqcal
