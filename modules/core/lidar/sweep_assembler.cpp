#include "core/lidar/sweep_assembler.hpp"

#include <cmath>
#include <utility>

namespace voqcal {

PointCloud TimedSweep::Cloud(bool has_ring) const {
  PointCloud cloud;
  cloud.has_intensity = cloud.has_time = true;
  cloud.has_ring = has_ring;
  cloud.points.reserve(returns.size());
  for (const PacketReturn& measured : returns) cloud.points.push_back(measured.point);
  return cloud;
}

void SweepAssembler::Add(const LidarPacket& packet,
                         std::int64_t utime,
                         std::vector<TimedSweep>* ended) {
  for (const PacketReturn& measured : packet.returns) {
    const auto after_us = static_cast<std::int64_t>(std::floor(measured.after_packet_us));
    if (Begins(measured.azimuth_rad, utime + after_us) && !sweep_.returns.empty()) {
      ended->push_back(std::exchange(sweep_, TimedSweep()));
    }
    if (sweep_.returns.empty()) sweep_.utime = utime + after_us;
    sweep_.returns.push_back(measured);
    const double since_first_us =
        static_cast<double>(utime - sweep_.utime) + measured.after_packet_us;
    sweep_.returns.back().point.time_s = static_cast<float>(1e-6 * since_first_us);
  }
}

std::optional<TimedSweep> SweepAssembler::Finish() {
  previous_rad_.reset();
  if (sweep_.returns.empty()) return std::nullopt;
  return std::exchange(sweep_, TimedSweep());
}

bool SweepAssembler::Begins(double azimuth_rad, std::int64_t utime) {
  constexpr std::int64_t kMaxPauseUs = 50000;
  constexpr double kMaxStepRad = 30.0 * M_PI / 180.0;
  const double from_split_rad = std::fmod(azimuth_rad - split_azimuth_rad_ + 4 * M_PI, 2 * M_PI);
  const std::optional<double> before_rad = std::exchange(previous_rad_, from_split_rad);
  const std::int64_t before_utime = std::exchange(previous_utime_, utime);
  if (!before_rad || utime - before_utime > kMaxPauseUs) return true;
  const double step_rad = from_split_rad - *before_rad;
  return end_ == SweepEnd::kAtAzimuth ? step_rad < -M_PI : std::abs(step_rad) > kMaxStepRad;
}

}  // namespace voqcal
