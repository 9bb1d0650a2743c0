#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/lidar_packets/lidar_protocols.hpp"
#include "core/lidar_packets/sweep_assembler.hpp"

namespace voqcal {

/// Which echoes of a beam are kept where the sensor sends several.
enum class ReturnChoice {
  kBoth,       ///< All.
  kStrongest,  ///< The one of highest intensity; of equal ones the last.
  kLast,
};

/// How a sensor's packets become sweeps.
struct LidarPacketOptions {
  const LidarProtocol* protocol = &LidarProtocols().front();  ///< Of the table.
  double split_azimuth_rad = M_PI;  ///< Where sweeps of a spinning lidar end, clockwise from ahead.
  ReturnChoice returns = ReturnChoice::kStrongest;
  LidarUnit unit;

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// A sensor's datagrams in, whole sweeps out.
///
/// Packets may arrive in another order than they were sent, by up to 4: they are sorted by the
/// sensor's clock. Later ones are left out, and so is a second copy of any of the last few (ports
/// that are mirrored). The sensor's clock may wrap; utime follows the host's clock at the first
/// packet, unless a sensor that can be synchronised is within half a second of it: then the
/// sensor's own. Where the two clocks part by more than a second (the sensor was switched on again,
/// the host's clock was set), utime follows the host's again from there; where the sensor's stands
/// still, it is the host's.
class LidarPacketStream {
 public:
  /// @throws std::invalid_argument if `options` have Problems(), or the calibration has.
  explicit LidarPacketStream(const LidarPacketOptions& options);

  /// @param host_utime  when it arrived, microseconds since the Unix epoch.
  /// @return the sweeps that have become complete.
  std::vector<TimedSweep> Add(PacketBytes bytes, std::int64_t host_utime);

  /// What is left at the end of a recording.
  std::vector<TimedSweep> Finish();

  /// "packets", "packets lost", "packets late", "packets twice", "clock restarts", "packets whose
  /// clock stood still", and each fault by its name.
  const std::map<std::string, std::int64_t>& Counts() const { return counts_; }

  /// What WrongLidarText says if there were datagrams, but none that is the sensor's; else empty.
  std::string WrongLidar() const;

 private:
  struct Waiting {
    std::int64_t utime = 0;
    LidarPacket packet;
  };

  bool IsSecondCopy(PacketBytes bytes);
  void StartClock(std::int64_t sensor_us, std::int64_t host_utime);
  /// Takes up the clock, or takes it up again where it went astray.
  void FollowClock(const LidarPacket& packet,
                   std::int64_t host_utime,
                   std::vector<TimedSweep>* ended);
  /// @return by the sensor's clock, unwrapped.
  std::int64_t UtimeOf(std::int64_t sensor_us) const;
  void CountLost(const Waiting& oldest);
  void Release(std::vector<TimedSweep>* ended);

  LidarPacketOptions options_;
  PacketDecoder decode_;
  SweepAssembler assembler_;
  std::deque<std::size_t> recent_;                // hashes of the last packets
  std::deque<Waiting> waiting_;                   // by time
  std::optional<std::int64_t> newest_sensor_us_;  // unwrapped
  std::optional<std::int64_t> previous_sensor_us_;
  std::int64_t utime_minus_sensor_us_ = 0;
  std::optional<std::int64_t> released_utime_;
  std::optional<std::uint32_t> released_number_;
  std::map<std::string, std::int64_t> counts_;
  bool is_calibration_missing_ = false;
  std::map<std::size_t, std::int64_t> sizes_;  // of datagrams that are none of the sensor's
};

}  // namespace voqcal
