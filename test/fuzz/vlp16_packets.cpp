// First byte: options. Then packets: two bytes of milliseconds since the one before, 1206 bytes;
// the last as long as the input is.
#include <algorithm>

#include "core/lidar_packets/packet_stream.hpp"
#include "fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kPacketBytes = 1206;
  voqcal::fuzz::Input input(data, size);
  voqcal::LidarPacketOptions options;
  const int choice = input.Byte();
  options.returns = static_cast<voqcal::ReturnChoice>(choice % 3);
  options.split_azimuth_rad = choice / 256.0 * 2 * M_PI;
  if (choice % 2 == 1) options.unit.ring_offsets_m.assign(16, 0.01);
  voqcal::LidarPacketStream stream(options);
  std::int64_t host_utime = 1700000000000000;
  while (input.size() > 0) {
    host_utime += 1000 * input.Word();
    const std::size_t num_bytes = std::min(input.size(), kPacketBytes);
    stream.Add({input.data(), num_bytes}, host_utime);
    input.Skip(num_bytes);
  }
  for (const voqcal::TimedSweep& sweep : stream.Finish()) sweep.Cloud(true);
  return 0;
}
