#include "core/simulation/stop_finder.hpp"

#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kMaxTiltRad = 40 * kRadPerDeg;  // yaw and pitch, each
constexpr double kMidRollRad = 45 * kRadPerDeg;  // a diamond: beams cross all four edges
constexpr double kMaxRollOffsetRad = 15 * kRadPerDeg;
constexpr int kTrialsInStratum = 400;  // keeping to its share of width and distances
constexpr int kTrialsAnywhere = 20000;

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

}  // namespace

StopFinder::StopFinder(const SimulationOptions& options,
                       const CameraModel& camera,
                       StopChecks checks)
    : options_(options),
      camera_(camera),
      checks_(std::move(checks)),
      R_lidar_camera_(options.T_camera_lidar.linear().transpose()),
      forward_azimuth_rad_(ForwardAzimuthRad(options.T_camera_lidar)) {}

std::optional<BoardPlace> StopFinder::Find(const KeyedNoise& noise,
                                           int first_trial,
                                           int num_trials,
                                           double column,
                                           double distance,
                                           double share) const {
  for (int trial = first_trial; trial < first_trial + num_trials; ++trial) {
    const auto place = Place(noise, trial, column, distance, share);
    if (place && checks_.IsGood(PoseOf(*place))) return place;
  }
  return std::nullopt;
}

std::optional<BoardPlace> StopFinder::FindAnywhere(const KeyedNoise& noise) const {
  return Find(noise, kTrialsInStratum, kTrialsAnywhere, 0.0, 0.0, 1.0);
}

std::optional<BoardPlace> StopFinder::Place(
    const KeyedNoise& noise, int trial, double column, double distance, double share) const {
  const auto draw = [&](int i) { return noise.Uniform(static_cast<std::uint64_t>(trial) * 8 + i); };
  const auto within = [](double part, double limit) { return (2 * part - 1) * limit; };
  const auto ray_camera = camera_.Unproject(
      {(column + share * draw(0)) * (camera_.width_px - 1), draw(2) * (camera_.height_px - 1)});
  if (!ray_camera) return std::nullopt;
  const Eigen::Vector3d ray = R_lidar_camera_ * *ray_camera;
  BoardPlace place;
  place[0] = std::atan2(ray.y(), ray.x());
  place[1] = std::atan2(ray.z(), ray.head<2>().norm());
  place[2] = options_.min_distance_m +
             (distance + share * draw(1)) * (options_.max_distance_m - options_.min_distance_m);
  place[3] = within(draw(3), kMaxTiltRad);
  place[4] = within(draw(4), kMaxTiltRad);
  place[5] = kMidRollRad + within(draw(5), kMaxRollOffsetRad);
  return Unwound(place, forward_azimuth_rad_);
}

std::vector<BoardPlace> FindStops(const SimulationOptions& options,
                                  const std::vector<StopFinder>& finders) {
  const KeyedNoise order_noise(options.seed, NoiseUse::kStopOrder);
  const double share = 1.0 / options.num_poses;
  const auto columns = ShuffledOrder(options.num_poses, order_noise, 0);
  const auto distances = ShuffledOrder(options.num_poses, order_noise, options.num_poses);
  std::vector<BoardPlace> stops;
  for (int i = 0; i < options.num_poses; ++i) {
    const KeyedNoise noise(options.seed, NoiseUse::kStops, i);
    const StopFinder& finder = finders[static_cast<std::size_t>(i) % finders.size()];
    auto stop =
        finder.Find(noise, 0, kTrialsInStratum, columns[i] * share, distances[i] * share, share);
    if (!stop) stop = finder.FindAnywhere(noise);
    if (!stop) ThrowNoPlace(options, i);
    stops.push_back(*stop);
  }
  return stops;
}

}  // namespace voqcal
