#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/lidar_packets/packet_stream.hpp"
#include "core/likelihood/lidar_bias.hpp"
#include "lidar_driver/lidar_source.hpp"
#include "lidar_driver/packet_source.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Sweeps from a sensor's own packets, of the network or of a capture. The points' times follow
/// from the packets and their times of arrival alone.
class PacketLidarSource : public LidarSource {
 public:
  /// @throws std::runtime_error naming the calibration's file and what is wrong with it.
  /// @param on_packet  called with each datagram, understood or not; may be empty.
  PacketLidarSource(const LidarSensorOptions& options, PacketListener on_packet);

  std::optional<TimedCloud> Next() override;
  bool HasEnded() const override { return has_ended_ && ready_.empty(); }
  SweepPace Pace() const override { return pace_; }
  /// Says so if what comes is another sensor's.
  std::string State() const override;
  std::map<std::string, std::int64_t> Counts() const override;

 private:
  /// One datagram; false if there is none now.
  /// @throws std::runtime_error at the end of a capture that has no packet of this lidar.
  bool Read();
  void RefuseWrongLidar() const;

  LidarPacketStream stream_;
  bool has_ring_;
  LidarBias bias_;
  PacketListener on_packet_;
  SweepPace pace_;
  std::unique_ptr<PacketSource> packets_;
  std::deque<TimedSweep> ready_;
  bool has_ended_ = false;
};

}  // namespace voqcal
