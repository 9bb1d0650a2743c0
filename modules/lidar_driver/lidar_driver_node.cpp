#include "lidar_driver/lidar_driver_node.hpp"

#include "messaging/convert_points.hpp"
#include "voqcal/raw_t.hpp"

namespace voqcal {
namespace {

using std::chrono::microseconds;

// A capture may pause for hours, or start again at an earlier time: nobody waits for that.
constexpr microseconds kLongestPause = std::chrono::seconds(2);

raw_t ToMessage(const HostPacket& packet) {
  raw_t message{};
  message.utime = packet.utime;
  message.length = static_cast<std::int32_t>(packet.bytes.size());
  message.data = packet.bytes;
  return message;
}

PacketListener PublisherOfPackets(const Rig& rig, Bus* bus) {
  if (!rig.lidar_sensor.are_packets_published) return {};
  return [bus, channel = rig.channels.lidar_packets](const HostPacket& packet) {
    bus->Publish(channel, ToMessage(packet));
  };
}

}  // namespace

LidarDriverNode::LidarDriverNode(const Rig& rig, Bus* bus)
    : channel_(rig.channels.lidar_points),
      bus_(*bus),
      source_(MakeLidarSource(rig, PublisherOfPackets(rig, bus), bus)),
      pacer_(rig.lidar_driver.rate_hz),
      next_(pacer_.Next()) {}

bool LidarDriverNode::Step() {
  if (is_done_ || Clock::now() < next_) return false;
  FetchSweep();
  if (!waiting_) return false;
  next_ = DueTime();
  if (Clock::now() >= next_) PublishSweep();
  return false;
}

void LidarDriverNode::FetchSweep() {
  if (!waiting_) waiting_ = source_->Next();
  for (const auto& [what, count] : source_->Counts()) SetCount(what, count);
  is_done_ = !waiting_ && source_->HasEnded();
}

LidarDriverNode::Clock::time_point LidarDriverNode::DueTime() {
  if (source_->Pace() != SweepPace::kTheirTimes) return next_;
  const microseconds sweep_time(waiting_->utime);
  const auto now = std::chrono::duration_cast<microseconds>(Clock::now().time_since_epoch());
  if (!steady_minus_sweep_ || abs(*steady_minus_sweep_ + sweep_time - now) > kLongestPause) {
    steady_minus_sweep_ = now - sweep_time;
  }
  return Clock::time_point(*steady_minus_sweep_ + sweep_time);
}

void LidarDriverNode::PublishSweep() {
  bus_.Publish(channel_, ToMessage(waiting_->cloud_lidar_m, waiting_->utime, seq_++));
  waiting_.reset();
  Count("sweeps");
  if (source_->Pace() != SweepPace::kRate) return;
  pacer_.Advance();
  next_ = pacer_.Next();
}

}  // namespace voqcal
