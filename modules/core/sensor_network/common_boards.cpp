#include "core/sensor_network/common_boards.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "core/estimation/set_extrinsic.hpp"
#include "core/estimation/variance_components.hpp"
#include "core/geometry/rigid.hpp"
#include "core/least_samples.hpp"

namespace voqcal {
namespace {

bool IsNew(const BoardPose& pose,
           const std::vector<CommonBoard>& boards,
           const CommonBoardLimits& limits) {
  return std::none_of(boards.begin(), boards.end(), [&](const CommonBoard& each) {
    return (each.from.centre_m - pose.centre_m).norm() < limits.min_new_distance_m &&
           AngleBetween(each.from.normal, pose.normal) < limits.min_new_angle_rad;
  });
}

}  // namespace

void AddCommonBoards(const std::vector<SeenBoard>& from,
                     const std::vector<SeenBoard>& to,
                     const CommonBoardLimits& limits,
                     std::vector<CommonBoard>* boards) {
  for (const SeenBoard& each : from) {
    for (const SeenBoard& other : to) {
      const double apart_s =
          1e-6 * static_cast<double>(std::abs(each.camera_utime - other.camera_utime));
      if (apart_s > limits.max_apart_s || !IsNew(each.pose, *boards, limits)) continue;
      boards->push_back({each.pose, other.pose});
    }
  }
}

std::optional<SensorPair> PairOfCameras(const std::string& from,
                                        const std::string& to,
                                        const std::vector<CommonBoard>& boards,
                                        const CameraModel& to_camera) {
  if (boards.size() < kLeastSamples) return std::nullopt;
  std::vector<BoardSample> samples;  // `from` in the lidar's place
  for (const CommonBoard& board : boards) {
    BoardSample& sample = samples.emplace_back();
    sample.id = static_cast<std::int64_t>(samples.size());
    sample.lidar.pose = board.from;
    sample.camera.pose = board.to;
  }
  std::vector<const BoardSample*> all;
  for (const BoardSample& sample : samples) all.push_back(&sample);
  const MixedFit fit = FitWithErrors(all, to_camera, AnalyticExtrinsic(all), kCameraErrorPriors);
  if (!fit.is_usable) return std::nullopt;
  return SensorPair{from, to, fit.T_camera_lidar, fit.ExtrinsicCovariance()};
}

}  // namespace voqcal
