#include "core/lidar/packet_stream.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/lidar/spectrum_scan.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMaxWaiting = 4;
constexpr std::int64_t kSynchronisedUs = 500000;
// Drift of a free-running clock stays below it for hours.
constexpr std::int64_t kMaxClockGapUs = 1000000;

// In (-period / 2, period / 2].
std::int64_t Centred(std::int64_t difference, std::int64_t period) {
  const std::int64_t remainder = ((difference % period) + period) % period;
  return remainder > period / 2 ? remainder - period : remainder;
}

// Of a beam's two echoes the decoder puts the last first.
void KeepOneOfTwo(ReturnChoice choice, std::vector<PacketReturn>* returns) {
  std::vector<PacketReturn> kept;
  kept.reserve(returns->size());
  for (const PacketReturn& echo : *returns) {
    if (echo.kind != ReturnKind::kOther) {
      kept.push_back(echo);
    } else if (choice == ReturnChoice::kStrongest &&
               echo.point.intensity > kept.back().point.intensity) {
      kept.back() = echo;
    }
  }
  *returns = std::move(kept);
}

}  // namespace

std::string ToString(PacketFault fault) {
  switch (fault) {
    case PacketFault::kWrongSize:
      return "packets of a wrong size";
    case PacketFault::kAlien:
      return "packets of another sensor";
    case PacketFault::kUnknownMode:
      return "packets in an unknown return mode";
  }
  return "packets with an unknown fault";
}

std::vector<std::string> LidarPacketOptions::Problems() const {
  ProblemList problems;
  problems.Add(vlp16.Problems());
  problems.Require(split_azimuth_rad >= 0 && split_azimuth_rad < 2 * M_PI,
                   "split_azimuth_deg must be from 0 to below 360",
                   split_azimuth_rad * 180.0 / M_PI);
  return problems.lines();
}

LidarPacketStream::LidarPacketStream(const LidarPacketOptions& options)
    : options_(options),
      clock_us_(options.model == LidarModel::kVlp16 ? std::int64_t{kVlp16ClockUs}
                                                    : std::int64_t{1} << 32),
      assembler_(options.model == LidarModel::kVlp16 ? SweepEnd::kAtAzimuth : SweepEnd::kAtJump,
                 options.model == LidarModel::kVlp16 ? options.split_azimuth_rad : 0.0) {
  RequireUsable("LidarPacketOptions", options.Problems());
}

std::vector<TimedSweep> LidarPacketStream::Add(PacketBytes bytes, std::int64_t host_utime) {
  std::vector<TimedSweep> ended;
  auto packet = options_.model == LidarModel::kVlp16
                    ? DecodeVlp16(bytes, options_.vlp16)
                    : DecodeSpectrumScan(bytes, options_.vlp16.distance_offset_m);
  if (!packet) {
    ++counts_[ToString(packet.error())];
    return ended;
  }
  if (options_.model == LidarModel::kVlp16 && options_.returns != ReturnChoice::kBoth) {
    KeepOneOfTwo(options_.returns, &packet->returns);
  }
  if (!newest_sensor_us_) StartClock(packet->sensor_us, host_utime);
  if (std::abs(UtimeOf(packet->sensor_us) - host_utime) > kMaxClockGapUs) {
    ++counts_["clock restarts"];
    ended = Finish();
    released_utime_.reset();
    StartClock(packet->sensor_us, host_utime);
  }
  const std::int64_t utime = UtimeOf(packet->sensor_us);
  newest_sensor_us_ = std::max(*newest_sensor_us_, utime - utime_minus_sensor_us_);
  if (released_utime_ && utime < *released_utime_) {
    ++counts_["packets late"];
    return ended;
  }
  ++counts_["packets"];
  const auto place = std::upper_bound(
      waiting_.begin(), waiting_.end(), utime, [](std::int64_t value, const Waiting& waiting) {
        return value < waiting.utime;
      });
  waiting_.insert(place, {utime, std::move(*packet)});
  if (waiting_.size() > kMaxWaiting) Release(&ended);
  return ended;
}

std::vector<TimedSweep> LidarPacketStream::Finish() {
  std::vector<TimedSweep> ended;
  while (!waiting_.empty()) Release(&ended);
  if (auto last = assembler_.Finish()) ended.push_back(std::move(*last));
  return ended;
}

void LidarPacketStream::StartClock(std::uint32_t sensor_us, std::int64_t host_utime) {
  newest_sensor_us_ = sensor_us;
  const std::int64_t ahead_us = Centred(sensor_us - host_utime, clock_us_);
  const bool is_synchronised =
      options_.model == LidarModel::kVlp16 && std::abs(ahead_us) < kSynchronisedUs;
  utime_minus_sensor_us_ = host_utime + (is_synchronised ? ahead_us : 0) - sensor_us;
}

std::int64_t LidarPacketStream::UtimeOf(std::uint32_t sensor_us) const {
  const std::int64_t unwrapped_us =
      *newest_sensor_us_ + Centred(sensor_us - *newest_sensor_us_, clock_us_);
  return unwrapped_us + utime_minus_sensor_us_;
}

// The sensor sends at a steady rate: a gap of n periods stands for n - 1 lost packets.
void LidarPacketStream::Release(std::vector<TimedSweep>* ended) {
  const Waiting oldest = std::move(waiting_.front());
  waiting_.pop_front();
  if (released_utime_ && options_.model == LidarModel::kVlp16) {
    const double period_us = oldest.packet.is_dual ? kVlp16PacketUs / 2 : kVlp16PacketUs;
    const auto num_periods =
        std::llround(static_cast<double>(oldest.utime - *released_utime_) / period_us);
    if (num_periods > 1) counts_["packets lost"] += num_periods - 1;
  }
  released_utime_ = oldest.utime;
  assembler_.Add(oldest.packet, oldest.utime, ended);
}

}  // namespace voqcal
