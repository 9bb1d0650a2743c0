#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/lidar/sweep_assembler.hpp"
#include "core/lidar/vlp16.hpp"

namespace voqcal {

enum class LidarModel { kVlp16, kSpectrumScan };

/// Which echoes of a beam are kept where the sensor sends two.
enum class ReturnChoice {
  kBoth,
  kStrongest,  ///< The one of higher intensity; of equal ones the last.
  kLast,
};

/// How a sensor's packets become sweeps.
struct LidarPacketOptions {
  LidarModel model = LidarModel::kVlp16;
  double split_azimuth_rad = M_PI;  ///< VLP-16: where sweeps end, clockwise from ahead.
  ReturnChoice returns = ReturnChoice::kStrongest;  ///< VLP-16 only.
  Vlp16Options vlp16;  ///< The common distance offset holds for both models.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// A sensor's datagrams in, whole sweeps out.
///
/// Packets may arrive in another order than they were sent, by up to 4: they are sorted by the
/// sensor's clock. Later ones are left out. The sensor's clock wraps; utime follows the host's
/// clock at the first packet, unless a VLP-16's is within half a second of it (synchronised by
/// GPS): then the sensor's own. Where the two clocks part by more than a second (the sensor was
/// switched on again, the host's clock was set), utime follows the host's again from there.
class LidarPacketStream {
 public:
  /// @throws std::invalid_argument if `options` have Problems().
  explicit LidarPacketStream(const LidarPacketOptions& options);

  /// @param host_utime  when it arrived, microseconds since the Unix epoch.
  /// @return the sweeps that have become complete.
  std::vector<TimedSweep> Add(PacketBytes bytes, std::int64_t host_utime);

  /// What is left at the end of a recording.
  std::vector<TimedSweep> Finish();

  /// "packets", "packets lost", "packets late", "clock restarts", and each fault by its name.
  const std::map<std::string, std::int64_t>& Counts() const { return counts_; }

 private:
  struct Waiting {
    std::int64_t utime = 0;
    LidarPacket packet;
  };

  void StartClock(std::uint32_t sensor_us, std::int64_t host_utime);
  /// @return by the sensor's clock, unwrapped.
  std::int64_t UtimeOf(std::uint32_t sensor_us) const;
  void Release(std::vector<TimedSweep>* ended);

  LidarPacketOptions options_;
  std::int64_t clock_us_;  // after which the sensor's clock wraps
  SweepAssembler assembler_;
  std::deque<Waiting> waiting_;                   // by time
  std::optional<std::int64_t> newest_sensor_us_;  // unwrapped
  std::int64_t utime_minus_sensor_us_ = 0;
  std::optional<std::int64_t> released_utime_;
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace voqcal
