#include "lidar_driver/packet_lidar_source.hpp"

#include <stdexcept>
#include <utility>

#include "lidar_driver/calibrated_stream.hpp"
#include "lidar_driver/pcap_packets.hpp"
#include "lidar_driver/udp_packets.hpp"
#include "result/lidar_bias_yaml.hpp"

namespace voqcal {
namespace {

std::unique_ptr<PacketSource> MakePacketSource(const LidarSensorOptions& options) {
  return options.pcap.empty() ? MakeUdpPackets(options.address, options.Port())
                              : MakePcapPackets(options.pcap, options.Port());
}

SweepPace PaceOf(const LidarSensorOptions& options) {
  const bool is_paced = !options.pcap.empty() && !options.is_unpaced;
  return is_paced ? SweepPace::kTheirTimes : SweepPace::kAsTheyCome;
}

}  // namespace

PacketLidarSource::PacketLidarSource(const LidarSensorOptions& options, PacketListener on_packet)
    : stream_(CalibratedStream(options.packets, options.calibration)),
      has_ring_(options.packets.protocol->has_rings),
      bias_(options.bias_from.empty() ? LidarBias() : ReadLidarBias(options.bias_from)),
      on_packet_(std::move(on_packet)),
      pace_(PaceOf(options)),
      packets_(MakePacketSource(options)) {}

std::optional<TimedCloud> PacketLidarSource::Next() {
  constexpr int kMaxAtOnce = 100;  // packets: a lidar that sees nothing must not stop the heartbeat
  for (int i = 0; i < kMaxAtOnce && ready_.empty(); ++i) {
    if (!Read()) break;
  }
  if (ready_.empty()) return std::nullopt;
  const TimedSweep sweep = std::move(ready_.front());
  ready_.pop_front();
  return TimedCloud{sweep.utime, bias_.Corrected(sweep.Cloud(has_ring_))};
}

bool PacketLidarSource::Read() {
  if (has_ended_) return false;
  const auto packet = packets_->Next();
  has_ended_ = !packet && packets_->HasEnded();
  if (!packet && !has_ended_) return false;
  if (packet && on_packet_) on_packet_(*packet);
  auto sweeps = packet ? stream_.Add({packet->bytes.data(), packet->bytes.size()}, packet->utime)
                       : stream_.Finish();
  for (TimedSweep& sweep : sweeps) ready_.push_back(std::move(sweep));
  if (has_ended_) RefuseWrongLidar();
  return true;
}

std::string PacketLidarSource::State() const {
  const std::string wrong = stream_.WrongLidar();
  return wrong.empty() ? packets_->State() : wrong;
}

void PacketLidarSource::RefuseWrongLidar() const {
  const std::string wrong = stream_.WrongLidar();
  if (!wrong.empty()) throw std::runtime_error(packets_->Name() + ": " + wrong);
  const auto other = packets_->BusiestOtherPort();
  if (!stream_.Counts().empty() || !other) return;
  throw std::runtime_error(packets_->Name() + ": no packet to the lidar's port, but " +
                           std::to_string(other->num_packets) + " to port " +
                           std::to_string(other->port) +
                           ": set lidar_driver.sensor.port to the lidar's");
}

std::map<std::string, std::int64_t> PacketLidarSource::Counts() const {
  auto counts = stream_.Counts();
  counts.insert(packets_->Counts().begin(), packets_->Counts().end());
  return counts;
}

}  // namespace voqcal
