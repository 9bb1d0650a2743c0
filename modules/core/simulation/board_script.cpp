#include "core/simulation/board_script.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/stop_checks.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kMaxTiltRad = 40 * kRadPerDeg;  // yaw and pitch, each
constexpr double kMidRollRad = 45 * kRadPerDeg;  // a diamond: beams cross all four edges
constexpr double kMaxRollOffsetRad = 15 * kRadPerDeg;
constexpr int kTrialsInStratum = 400;  // keeping to its share of width and distances
constexpr int kTrialsAnywhere = 20000;

// Picks stops that are good.
class StopFinder {
 public:
  StopFinder(const SimulationOptions& options, const CameraModel& camera, StopChecks checks)
      : options_(options),
        camera_(camera),
        checks_(std::move(checks)),
        R_lidar_camera_(options.T_camera_lidar.linear().transpose()),
        forward_azimuth_rad_(ForwardAzimuthRad(options.T_camera_lidar)) {}

  // A stop whose centre is seen in [column, column + share) of the image's width and whose distance
  // is in the same way [distance, distance + share) of the distances, all within [0, 1].
  std::optional<BoardPlace> Find(const KeyedNoise& noise,
                                 int first_trial,
                                 int num_trials,
                                 double column,
                                 double distance,
                                 double share) const {
    for (int trial = first_trial; trial < first_trial + num_trials; ++trial) {
      const auto draw = [&](int i) {
        return noise.Uniform(static_cast<std::uint64_t>(trial) * 8 + i);
      };
      const auto place = Place(draw, column + share * draw(0), distance + share * draw(1));
      if (place && checks_.IsGood(PoseOf(*place))) return place;
    }
    return std::nullopt;
  }

 private:
  template <typename Draw>
  std::optional<BoardPlace> Place(const Draw& draw, double column, double distance) const {
    const auto ray_camera =
        camera_.Unproject({column * (camera_.width_px - 1), draw(2) * (camera_.height_px - 1)});
    if (!ray_camera) return std::nullopt;
    const Eigen::Vector3d ray = R_lidar_camera_ * *ray_camera;
    const auto within = [](double share, double limit) { return (2 * share - 1) * limit; };
    BoardPlace place;
    place[0] = std::atan2(ray.y(), ray.x());
    place[1] = std::atan2(ray.z(), ray.head<2>().norm());
    place[2] =
        options_.min_distance_m + distance * (options_.max_distance_m - options_.min_distance_m);
    place[3] = within(draw(3), kMaxTiltRad);
    place[4] = within(draw(4), kMaxTiltRad);
    place[5] = kMidRollRad + within(draw(5), kMaxRollOffsetRad);
    return Unwound(place, forward_azimuth_rad_);
  }

  const SimulationOptions& options_;
  const CameraModel& camera_;
  StopChecks checks_;
  Eigen::Matrix3d R_lidar_camera_;
  double forward_azimuth_rad_;
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

std::vector<BoardPlace> FindStops(const SimulationOptions& options, const StopFinder& finder) {
  const KeyedNoise order_noise(options.seed, NoiseUse::kStopOrder);
  const double share = 1.0 / options.num_poses;
  const auto columns = ShuffledOrder(options.num_poses, order_noise, 0);
  const auto distances = ShuffledOrder(options.num_poses, order_noise, options.num_poses);
  std::vector<BoardPlace> stops;
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
      stops_(FindStops(options,
                       StopFinder(options, camera, StopChecks(options, board, camera, room)))) {}

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
  return PoseOf(Between(stops_[phase.stop], stops_[phase.stop + 1], phase.moving_s / move_s_));
}

}  // namespace voqcal
