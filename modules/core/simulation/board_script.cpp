#include "core/simulation/board_script.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "core/geometry/rigid.hpp"
#include "core/simulation/board_prop.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/scan_pattern.hpp"

namespace voqcal {
namespace {

constexpr double kRadPerDeg = M_PI / 180.0;
constexpr double kMaxTiltRad = 40 * kRadPerDeg;     // yaw and pitch, each
constexpr double kMaxObliqueRad = 55 * kRadPerDeg;  // normal against the line of sight
constexpr double kMidRollRad = 45 * kRadPerDeg;     // a diamond: beams cross all four edges
constexpr double kMaxRollOffsetRad = 15 * kRadPerDeg;
constexpr double kBeamMarginRad = 0.25 * kRadPerDeg;
constexpr double kImageMarginShare = 0.02;  // of the shorter side
constexpr double kShellClearanceM = 0.2;
constexpr int kNumPerEdge = 6;         // outline points that are checked
constexpr int kTrialsInStratum = 400;  // keeping to its share of width and distances
constexpr int kTrialsAnywhere = 20000;

Eigen::Isometry3d PoseOf(const Placement& placement) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const double azimuth = placement[0];
  const double elevation = placement[1];
  const Vector3d level(std::cos(azimuth), std::sin(azimuth), 0.0);
  Eigen::Matrix3d R_lidar_upright;
  R_lidar_upright.col(2) = -level;
  R_lidar_upright.col(1) = Vector3d::UnitZ();
  R_lidar_upright.col(0) = Vector3d::UnitZ().cross(-level);
  Eigen::Isometry3d T_lidar_board = Eigen::Isometry3d::Identity();
  T_lidar_board.linear() = R_lidar_upright * (AngleAxisd(placement[3], Vector3d::UnitY()) *
                                              AngleAxisd(placement[4], Vector3d::UnitX()) *
                                              AngleAxisd(placement[5], Vector3d::UnitZ()))
                                                 .toRotationMatrix();
  T_lidar_board.translation() =
      placement[2] * (std::cos(elevation) * level + std::sin(elevation) * Vector3d::UnitZ());
  return T_lidar_board;
}

// Picks stops and checks them.
class StopFinder {
 public:
  StopFinder(const SimulationOptions& options,
             const BoardSpec& board,
             const CameraModel& camera,
             const Room& room)
      : options_(options),
        board_(board),
        camera_(camera),
        room_(room),
        T_lidar_camera_(options.T_camera_lidar.inverse()),
        forward_azimuth_rad_(std::atan2(T_lidar_camera_(1, 2), T_lidar_camera_(0, 2))),
        outline_board_m_(OutlinePointsBoardM(board, kNumPerEdge)) {}

  // A stop whose centre is seen in [column, column + share) of the image's width and whose distance
  // is in the same way [distance, distance + share) of the distances, all within [0, 1].
  std::optional<Placement> Find(const KeyedNoise& noise,
                                int first_trial,
                                int num_trials,
                                double column,
                                double distance,
                                double share) const {
    for (int trial = first_trial; trial < first_trial + num_trials; ++trial) {
      const auto draw = [&](int i) {
        return noise.Uniform(static_cast<std::uint64_t>(trial) * 8 + i);
      };
      const auto placement = Place(draw, column + share * draw(0), distance + share * draw(1));
      if (placement && IsGood(PoseOf(*placement))) return placement;
    }
    return std::nullopt;
  }

 private:
  template <typename Draw>
  std::optional<Placement> Place(const Draw& draw, double column, double distance) const {
    const auto ray_camera =
        camera_.Unproject({column * (camera_.width_px - 1), draw(2) * (camera_.height_px - 1)});
    if (!ray_camera) return std::nullopt;
    const Eigen::Vector3d ray = T_lidar_camera_.linear() * *ray_camera;
    const double azimuth = std::atan2(ray.y(), ray.x());
    const auto within = [](double share, double limit) { return (2 * share - 1) * limit; };
    Placement placement;
    // Turned to the same side of the camera's axis, so that a move never passes behind the camera.
    placement[0] =
        forward_azimuth_rad_ + std::remainder(azimuth - forward_azimuth_rad_, 2.0 * M_PI);
    placement[1] = std::atan2(ray.z(), ray.head<2>().norm());
    placement[2] =
        options_.min_distance_m + distance * (options_.max_distance_m - options_.min_distance_m);
    placement[3] = within(draw(3), kMaxTiltRad);
    placement[4] = within(draw(4), kMaxTiltRad);
    placement[5] = kMidRollRad + within(draw(5), kMaxRollOffsetRad);
    return placement;
  }

  bool IsGood(const Eigen::Isometry3d& T_lidar_board) const {
    std::vector<Eigen::Vector3d> outline_m;
    for (const auto& point : outline_board_m_) outline_m.push_back(T_lidar_board * point);
    return IsBetweenBeams(outline_m) && IsInImage(outline_m) && IsFacing(T_lidar_board) &&
           HasRoom(T_lidar_board, outline_m) && IsUnhidden(outline_m);
  }

  bool IsBetweenBeams(const std::vector<Eigen::Vector3d>& outline_m) const {
    return std::all_of(outline_m.begin(), outline_m.end(), [this](const Eigen::Vector3d& point) {
      return IsInFieldOfView(options_.scan.pattern, point, kBeamMarginRad);
    });
  }

  bool IsInImage(const std::vector<Eigen::Vector3d>& outline_m) const {
    const double margin_px = kImageMarginShare * std::min(camera_.width_px, camera_.height_px);
    return std::all_of(outline_m.begin(), outline_m.end(), [&](const auto& point) {
      const Eigen::Vector3d point_camera_m = options_.T_camera_lidar * point;
      if (!camera_.IsInFront(point_camera_m)) return false;
      const Eigen::Vector2d pixel = camera_.Project(point_camera_m);
      return pixel.minCoeff() > margin_px && pixel.x() < camera_.width_px - 1 - margin_px &&
             pixel.y() < camera_.height_px - 1 - margin_px;
    });
  }

  bool IsFacing(const Eigen::Isometry3d& T_lidar_board) const {
    const Eigen::Vector3d normal = T_lidar_board.linear().col(2);
    const Eigen::Vector3d centre_m = T_lidar_board.translation();
    return AngleBetween(normal, -centre_m) < kMaxObliqueRad &&
           AngleBetween(normal, T_lidar_camera_.translation() - centre_m) < kMaxObliqueRad;
  }

  bool HasRoom(const Eigen::Isometry3d& T_lidar_board,
               const std::vector<Eigen::Vector3d>& outline_m) const {
    const double half_diagonal_m = std::hypot(board_.width_m, board_.height_m) / 2;
    if (room_.DistanceToFurnitureM(T_lidar_board.translation()) < half_diagonal_m) return false;
    const auto tubes = StandTubes(T_lidar_board, board_, room_.FloorZM());
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

  bool IsUnhidden(const std::vector<Eigen::Vector3d>& outline_m) const {
    for (const Eigen::Vector3d& origin_m : {Eigen::Vector3d(Eigen::Vector3d::Zero()),
                                            Eigen::Vector3d(T_lidar_camera_.translation())}) {
      for (const auto& point : outline_m) {
        const double range_m = (point - origin_m).norm();
        if (room_.Cast(origin_m, (point - origin_m) / range_m).range_m < range_m) return false;
      }
    }
    return true;
  }

  const SimulationOptions& options_;
  const BoardSpec& board_;
  const CameraModel& camera_;
  const Room& room_;
  Eigen::Isometry3d T_lidar_camera_;
  double forward_azimuth_rad_;
  std::vector<Eigen::Vector3d> outline_board_m_;
};

// 0 .. count - 1 in random order.
std::vector<int> ShuffledOrder(int count, const KeyedNoise& noise, int first_index) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  for (int i = count - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<int>(noise.Uniform(first_index + i) * (i + 1))]);
  }
  return order;
}

[[noreturn]] void ThrowNoPlace(const SimulationOptions& options, int stop) {
  std::ostringstream text;
  text << "no place for stop " << stop + 1 << " of " << options.num_poses << ": at "
       << options.min_distance_m << " to " << options.max_distance_m
       << " m the board is nowhere whole in the view of camera and lidar, in the room and unhidden";
  throw std::invalid_argument(text.str());
}

std::vector<Placement> FindStops(const SimulationOptions& options, const StopFinder& finder) {
  const KeyedNoise order_noise(options.seed, NoiseUse::kStopOrder);
  const double share = 1.0 / options.num_poses;
  const auto columns = ShuffledOrder(options.num_poses, order_noise, 0);
  const auto distances = ShuffledOrder(options.num_poses, order_noise, options.num_poses);
  std::vector<Placement> stops;
  for (int i = 0; i < options.num_poses; ++i) {
    const KeyedNoise noise(options.seed, NoiseUse::kStops, i);
    auto stop =
        finder.Find(noise, 0, kTrialsInStratum, columns[i] * share, distances[i] * share, share);
    if (!stop) stop = finder.Find(noise, kTrialsInStratum, kTrialsAnywhere, 0.0, 0.0, 1.0);
    if (!stop) ThrowNoPlace(options, i);
    stops.push_back(*stop);
  }
  return stops;
}

}  // namespace

BoardScript::BoardScript(const SimulationOptions& options,
                         const BoardSpec& board,
                         const CameraModel& camera,
                         const Room& room)
    : hold_s_(options.hold_s),
      move_s_(options.move_s),
      stops_(FindStops(options, StopFinder(options, board, camera, room))) {}

double BoardScript::DurationS() const {
  const auto num_stops = static_cast<double>(stops_.size());
  return num_stops * hold_s_ + (num_stops - 1) * move_s_;
}

BoardScript::Phase BoardScript::PhaseAt(double time_s) const {
  const double time_in_script_s = std::clamp(time_s, 0.0, DurationS());
  const double period_s = hold_s_ + move_s_;
  const auto last = static_cast<int>(stops_.size()) - 1;
  const int stop = std::min(static_cast<int>(time_in_script_s / period_s), last);
  const double moving_s = time_in_script_s - stop * period_s - hold_s_;
  return {stop, stop == last ? 0.0 : std::max(moving_s, 0.0)};
}

bool BoardScript::IsStill(double time_s) const { return PhaseAt(time_s).moving_s == 0; }

Eigen::Isometry3d BoardScript::T_lidar_board(double time_s) const {
  const Phase phase = PhaseAt(time_s);
  if (phase.moving_s == 0) return PoseOf(stops_[phase.stop]);
  // 6t^5 - 15t^4 + 10t^3 begins and ends without speed and acceleration.
  const double t = phase.moving_s / move_s_;
  const double eased = t * t * t * (t * (6 * t - 15) + 10);
  return PoseOf(stops_[phase.stop] + eased * (stops_[phase.stop + 1] - stops_[phase.stop]));
}

}  // namespace voqcal
