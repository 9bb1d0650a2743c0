#include "core/lidar_packets/packet_stream.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/problems.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kMaxWaiting = 4;
constexpr std::size_t kMaxRecent = 8;  // a mirrored port's copy comes with or after its original
constexpr std::int64_t kSynchronisedUs = 500000;
// Drift of a free-running clock stays below it for hours.
constexpr std::int64_t kMaxClockGapUs = 1000000;

// In (-period / 2, period / 2].
std::int64_t Centred(std::int64_t difference, std::int64_t period) {
  const std::int64_t remainder = ((difference % period) + period) % period;
  return remainder > period / 2 ? remainder - period : remainder;
}

// Of each beam's echoes, which stand next to each other, the nearest first.
void KeepOneOfEachBeam(ReturnChoice choice, std::vector<PacketReturn>* returns) {
  std::size_t num_kept = 0;
  for (std::size_t i = 0; i < returns->size(); ++i) {
    const PacketReturn& echo = (*returns)[i];
    const bool is_first = echo.number == 1 || echo.of_how_many == 1 || num_kept == 0;
    if (is_first) ++num_kept;
    PacketReturn& kept = (*returns)[num_kept - 1];
    if (is_first || choice == ReturnChoice::kLast || echo.point.intensity >= kept.point.intensity) {
      kept = echo;
    }
  }
  returns->resize(num_kept);
}

// Ranges that read long are shortened along their beams.
void TakeOffOffsets(const LidarUnit& unit, std::vector<PacketReturn>* returns) {
  if (unit.distance_offset_m == 0.0 && unit.ring_offsets_m.empty()) return;
  for (PacketReturn& echo : *returns) {
    const double offset_m =
        unit.distance_offset_m +
        (echo.point.ring < unit.ring_offsets_m.size() ? unit.ring_offsets_m[echo.point.ring] : 0.0);
    echo.point.position_m *= static_cast<float>(1.0 - offset_m / echo.distance_m);
  }
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
    case PacketFault::kWithoutPoints:
      return "packets without points";
    case PacketFault::kWithoutCalibration:
      return "packets before the sensor's calibration came";
  }
  return "packets with an unknown fault";
}

std::vector<std::string> LidarPacketOptions::Problems() const {
  ProblemList problems;
  const auto require_one_a_ring = [&](const char* name, const std::vector<double>& list) {
    const auto num = static_cast<int>(list.size());
    problems.Require(num == 0 || num == protocol->num_rings,
                     name + std::string(" must have ") + std::to_string(protocol->num_rings) +
                         " entries or none for " + protocol->name,
                     num);
  };
  require_one_a_ring("elevations_deg", unit.elevations_rad);
  require_one_a_ring("ring_offsets_m", unit.ring_offsets_m);
  for (const double elevation_rad : unit.elevations_rad) {
    problems.Require(std::abs(elevation_rad) < M_PI / 2,
                     "elevations_deg must be within -90 and 90",
                     elevation_rad / kRadPerDeg);
  }
  problems.Require(split_azimuth_rad >= 0 && split_azimuth_rad < 2 * M_PI,
                   "split_azimuth_deg must be from 0 to below 360",
                   split_azimuth_rad / kRadPerDeg);
  return problems.lines();
}

LidarPacketStream::LidarPacketStream(const LidarPacketOptions& options)
    : options_(options),
      assembler_(
          options.protocol->sweep_end, options.split_azimuth_rad, options.protocol->overlap_rad) {
  RequireUsable("LidarPacketOptions", options.Problems());
  decode_ = options.protocol->make_decoder(options.unit);
}

std::vector<TimedSweep> LidarPacketStream::Add(PacketBytes bytes, std::int64_t host_utime) {
  std::vector<TimedSweep> ended;
  auto packet = decode_(bytes);
  if (!packet) {
    ++counts_[ToString(packet.error())];
    is_calibration_missing_ |= packet.error() == PacketFault::kWithoutCalibration;
    if (packet.error() != PacketFault::kWithoutPoints) ++sizes_[bytes.size];
    return ended;
  }
  if (IsSecondCopy(bytes)) {
    ++counts_["packets twice"];
    return ended;
  }
  if (options_.returns != ReturnChoice::kBoth) {
    KeepOneOfEachBeam(options_.returns, &packet->returns);
  }
  TakeOffOffsets(options_.unit, &packet->returns);
  FollowClock(*packet, host_utime, &ended);
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
  assembler_.Finish(&ended);
  return ended;
}

std::string LidarPacketStream::WrongLidar() const {
  if (counts_.count("packets") > 0 || sizes_.empty()) return {};
  if (is_calibration_missing_) {
    return "no calibration of this " + options_.protocol->title + " came: capture its " +
           "state packets too, or give its file (" + options_.protocol->calibration + ')';
  }
  return WrongLidarText(*options_.protocol, sizes_);
}

bool LidarPacketStream::IsSecondCopy(PacketBytes bytes) {
  const std::size_t hash =
      std::hash<std::string_view>()({reinterpret_cast<const char*>(bytes.data), bytes.size});
  if (std::find(recent_.begin(), recent_.end(), hash) != recent_.end()) return true;
  recent_.push_back(hash);
  if (recent_.size() > kMaxRecent) recent_.pop_front();
  return false;
}

void LidarPacketStream::StartClock(std::int64_t sensor_us, std::int64_t host_utime) {
  newest_sensor_us_ = sensor_us;
  const std::int64_t ahead_us = Centred(sensor_us - host_utime, options_.protocol->clock_us);
  const bool is_synchronised = options_.protocol->has_utc && std::abs(ahead_us) < kSynchronisedUs;
  utime_minus_sensor_us_ = host_utime + (is_synchronised ? ahead_us : 0) - sensor_us;
}

void LidarPacketStream::FollowClock(const LidarPacket& packet,
                                    std::int64_t host_utime,
                                    std::vector<TimedSweep>* ended) {
  const std::optional<std::int64_t> previous_us =
      std::exchange(previous_sensor_us_, packet.sensor_us);
  if (!previous_us) {
    StartClock(packet.sensor_us, host_utime);
  } else if (*previous_us == packet.sensor_us) {
    ++counts_["packets whose clock stood still"];
    utime_minus_sensor_us_ = host_utime - packet.sensor_us;
    newest_sensor_us_ = packet.sensor_us;
  } else if (std::abs(UtimeOf(packet.sensor_us) - host_utime) > kMaxClockGapUs) {
    ++counts_["clock restarts"];
    *ended = Finish();
    released_utime_.reset();
    released_number_.reset();
    StartClock(packet.sensor_us, host_utime);
  }
}

std::int64_t LidarPacketStream::UtimeOf(std::int64_t sensor_us) const {
  const std::int64_t unwrapped_us =
      *newest_sensor_us_ + Centred(sensor_us - *newest_sensor_us_, options_.protocol->clock_us);
  return unwrapped_us + utime_minus_sensor_us_;
}

// By the sensor's own count; or it sends at a steady rate: a gap of n periods stands for n - 1 lost
// packets.
void LidarPacketStream::CountLost(const Waiting& oldest) {
  std::int64_t num_lost = 0;
  if (oldest.packet.number && released_number_) {
    num_lost = static_cast<std::int32_t>(*oldest.packet.number - *released_number_) - 1;
  } else if (released_utime_ && oldest.packet.period_us > 0.0) {
    num_lost = std::llround(static_cast<double>(oldest.utime - *released_utime_) /
                            oldest.packet.period_us) -
               1;
  }
  if (num_lost > 0) counts_["packets lost"] += num_lost;
}

void LidarPacketStream::Release(std::vector<TimedSweep>* ended) {
  const Waiting oldest = std::move(waiting_.front());
  waiting_.pop_front();
  CountLost(oldest);
  released_utime_ = oldest.utime;
  released_number_ = oldest.packet.number;
  assembler_.Add(oldest.packet, oldest.utime, ended);
}

}  // namespace voqcal
