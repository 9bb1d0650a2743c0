#include "core/lidar_packets/sweep_assembler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace voqcal {
namespace {

constexpr double kTurnRad = 2 * M_PI;
constexpr std::int64_t kMaxPauseUs = 50000;
constexpr std::int64_t kSweepUs = 100000;  // for kAtTime

}  // namespace

PointCloud TimedSweep::Cloud(bool has_ring) const {
  PointCloud cloud;
  cloud.has_intensity = cloud.has_time = true;
  cloud.has_ring = has_ring;
  cloud.points.reserve(returns.size());
  for (const PacketReturn& measured : returns) {
    cloud.points.push_back(measured.point);
    cloud.points.back().return_number = static_cast<std::uint8_t>(measured.number);
    cloud.has_return_number |= measured.number > 1 || measured.of_how_many > 1;
  }
  return cloud;
}

void SweepAssembler::Add(const LidarPacket& packet,
                         std::int64_t utime,
                         std::vector<TimedSweep>* ended) {
  if (utime - previous_utime_ > kMaxPauseUs) Finish(ended);
  previous_utime_ = utime;
  for (const PacketReturn& measured : packet.returns) {
    const std::int64_t number = std::max(SweepOf(measured, packet, utime), oldest_);
    Open& sweep = open_[number];
    if (sweep.returns.empty()) sweep.base_utime = utime;
    sweep.returns.push_back(measured);
    sweep.returns.back().after_packet_us += static_cast<double>(utime - sweep.base_utime);
    if (number > oldest_ && IsPast(number)) CloseBefore(number, ended);
  }
}

void SweepAssembler::Finish(std::vector<TimedSweep>* ended) {
  CloseBefore(INT64_MAX, ended);
  oldest_ = INT64_MIN;
  previous_rad_.reset();
}

std::int64_t SweepAssembler::SweepOf(const PacketReturn& measured,
                                     const LidarPacket& packet,
                                     std::int64_t utime) {
  switch (end_) {
    case SweepEnd::kAtAzimuth:
      return SweepAtAzimuth(measured.azimuth_rad);
    case SweepEnd::kAtJump:
      return SweepAtJump(measured.azimuth_rad);
    case SweepEnd::kAtFrame:
      newest_frame_ += static_cast<std::int16_t>(packet.frame - newest_frame_);
      return newest_frame_;
    case SweepEnd::kAtTime:
      return utime / kSweepUs;
  }
  return 0;
}

// Each azimuth is the nearest to the one before it: beams lie within half a turn of each other.
std::int64_t SweepAssembler::SweepAtAzimuth(double azimuth_rad) {
  const double from_split_rad =
      std::fmod(azimuth_rad - split_azimuth_rad_ + 2 * kTurnRad, kTurnRad);
  const double before_rad = previous_rad_.value_or(from_split_rad);
  const double num_turns = std::round((before_rad - from_split_rad) / kTurnRad);
  previous_rad_ = from_split_rad + num_turns * kTurnRad;
  return static_cast<std::int64_t>(num_turns);
}

std::int64_t SweepAssembler::SweepAtJump(double azimuth_rad) {
  constexpr double kMaxStepRad = 30.0 * M_PI / 180.0;
  const double before_rad = std::exchange(previous_rad_, azimuth_rad).value_or(azimuth_rad);
  if (std::abs(azimuth_rad - before_rad) > kMaxStepRad) ++num_jumps_;
  return num_jumps_;
}

bool SweepAssembler::IsPast(std::int64_t number) const {
  if (end_ != SweepEnd::kAtAzimuth) return true;
  return *previous_rad_ - static_cast<double>(number) * kTurnRad >= overlap_rad_;
}

void SweepAssembler::CloseBefore(std::int64_t number, std::vector<TimedSweep>* ended) {
  while (!open_.empty() && open_.begin()->first < number) {
    Open open = std::move(open_.begin()->second);
    open_.erase(open_.begin());
    const auto first = std::min_element(
        open.returns.begin(), open.returns.end(), [](const auto& a, const auto& b) {
          return a.after_packet_us < b.after_packet_us;
        });
    const double begin_us = std::floor(first->after_packet_us);
    TimedSweep sweep{open.base_utime + static_cast<std::int64_t>(begin_us),
                     std::move(open.returns)};
    for (PacketReturn& measured : sweep.returns) {
      measured.point.time_s = static_cast<float>(1e-6 * (measured.after_packet_us - begin_us));
    }
    ended->push_back(std::move(sweep));
  }
  oldest_ = number;
}

}  // namespace voqcal
