#include "core/lidar_packets/lidar_recognition.hpp"

#include <algorithm>
#include <stdexcept>

namespace voqcal {
namespace {

bool IsTakenBy(const LidarProtocol& protocol, PacketBytes datagram, const LidarUnit& unit) {
  if (protocol.needs_calibration && unit.calibration.empty()) return false;
  try {
    const auto packet = protocol.make_decoder(unit)(datagram);
    return packet || packet.error() == PacketFault::kWithoutCalibration;
  } catch (const std::invalid_argument&) {
    return false;  // the calibration is another lidar's
  }
}

}  // namespace

std::vector<const LidarProtocol*> LidarsThatSend(PacketBytes datagram,
                                                 const std::string& calibration) {
  LidarUnit unit;
  unit.calibration = calibration;
  std::vector<const LidarProtocol*> senders;
  for (const LidarProtocol& protocol : LidarProtocols()) {
    const bool is_known =
        std::any_of(senders.begin(), senders.end(), [&protocol](const LidarProtocol* sender) {
          return sender->make_decoder == protocol.make_decoder;
        });
    const bool is_size =
        protocol.packet_bytes.empty() ||
        std::count(protocol.packet_bytes.begin(), protocol.packet_bytes.end(), datagram.size) > 0;
    if (!is_known && is_size && IsTakenBy(protocol, datagram, unit)) senders.push_back(&protocol);
  }
  return senders;
}

}  // namespace voqcal
