// Packets of any lidar of the table. First byte: which; second: which returns. Then packets: two
// bytes of milliseconds since the one before, two of length, then it. Those that need a calibration
// get the smallest one that will do.
#include <algorithm>
#include <string>

#include "core/lidar_packets/packet_stream.hpp"
#include "fuzz/fuzz_input.hpp"

namespace {

std::string Calibration(const voqcal::LidarProtocol& protocol) {
  if (!protocol.needs_calibration) return {};
  if (protocol.num_rings == 0) {
    return R"({"beam_altitude_angles": [1, 0], "beam_azimuth_angles": [0, 0], "data_format":
        {"pixels_per_column": 2, "columns_per_packet": 1, "columns_per_frame": 512,
         "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16_DUAL"}})";
  }
  std::string text = "lasers:\n";
  for (int i = 0; i < protocol.num_rings; ++i) {
    text += "- {laser_id: " + std::to_string(i) + ", rot_correction: 0, vert_correction: 0}\n";
  }
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  voqcal::fuzz::Input input(data, size);
  const auto& protocols = voqcal::LidarProtocols();
  voqcal::LidarPacketOptions options;
  options.protocol = &protocols[input.Byte() % protocols.size()];
  options.returns = static_cast<voqcal::ReturnChoice>(input.Byte() % 3);
  options.unit.calibration = Calibration(*options.protocol);
  voqcal::LidarPacketStream stream(options);
  std::int64_t host_utime = 1700000000000000;
  while (input.size() > 0) {
    host_utime += 1000 * input.Word();
    const auto wanted = static_cast<std::size_t>(input.Word());
    const std::size_t num_bytes = std::min(input.size(), wanted);
    stream.Add({input.data(), num_bytes}, host_utime);
    input.Skip(num_bytes);
  }
  for (const voqcal::TimedSweep& sweep : stream.Finish()) {
    sweep.Cloud(options.protocol->has_rings);
  }
  stream.WrongLidar();
  return 0;
}
