#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/lidar/point_cloud.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// One sweep and the time of its first point.
struct TimedCloud {
  std::int64_t utime = 0;
  PointCloud cloud_lidar_m;
};

/// Where the lidar driver's sweeps come from, one after the other.
class LidarSource {
 public:
  virtual ~LidarSource() = default;

  /// The next sweep; nothing when the source has ended.
  /// @throws std::runtime_error naming the file and the cause.
  virtual std::optional<TimedCloud> Next() = 0;
};

/// The source that the rig file names. Frames count from kSyntheticEpochUtime.
std::unique_ptr<LidarSource> MakeLidarSource(const Rig& rig);

}  // namespace voqcal
