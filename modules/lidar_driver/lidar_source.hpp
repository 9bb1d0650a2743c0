#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/lidar/point_cloud.hpp"
#include "lidar_driver/packet_source.hpp"
#include "messaging/bus.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// One sweep and the time of its first point.
struct TimedCloud {
  std::int64_t utime = 0;
  PointCloud cloud_lidar_m;
};

/// When a source's sweeps are published.
enum class SweepPace {
  kRate,        ///< At the rig's rate.
  kTheirTimes,  ///< As far apart as their times are: a capture, as it was recorded.
  kAsTheyCome,  ///< At once.
};

/// Where the lidar driver's sweeps come from, one after the other.
class LidarSource {
 public:
  virtual ~LidarSource() = default;

  /// The next sweep; nothing if there is none now, or never will be.
  /// @throws std::runtime_error naming the file and the cause.
  virtual std::optional<TimedCloud> Next() = 0;

  /// True once there will never be a sweep again.
  virtual bool HasEnded() const = 0;

  virtual SweepPace Pace() const { return SweepPace::kRate; }

  /// "running", or what it waits for.
  virtual std::string State() const { return "running"; }

  /// What it read and what it left out, by reason.
  virtual std::map<std::string, std::int64_t> Counts() const { return {}; }
};

/// Hears each datagram of a sensor.
using PacketListener = std::function<void(const HostPacket&)>;

/// The source that the rig file names. Frames of folders and the simulator count from
/// kSyntheticEpochUtime.
/// @param on_packet  for sources that read a sensor's packets; may be empty.
/// @param bus  for sources that listen; borrowed.
std::unique_ptr<LidarSource> MakeLidarSource(const Rig& rig, PacketListener on_packet, Bus* bus);

}  // namespace voqcal
