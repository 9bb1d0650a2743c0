#include "core/sensor_network/common_boards.hpp"

#include <cstdint>

#include "core/estimation/set_extrinsic.hpp"
#include "core/estimation/variance_components.hpp"
#include "core/least_samples.hpp"

namespace voqcal {
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
