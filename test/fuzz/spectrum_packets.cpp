// Packets of both versions: two bytes of milliseconds since the one before, two of length, then it.
#include <algorithm>

#include "core/lidar_packets/packet_stream.hpp"
#include "fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  voqcal::fuzz::Input input(data, size);
  voqcal::LidarPacketOptions options;
  options.protocol = voqcal::FindLidarProtocol("spectrum_scan");
  voqcal::LidarPacketStream stream(options);
  std::int64_t host_utime = 1700000000000000;
  while (input.size() > 0) {
    host_utime += 1000 * input.Word();
    const auto wanted = static_cast<std::size_t>(input.Word());
    const std::size_t num_bytes = std::min(input.size(), wanted);
    stream.Add({input.data(), num_bytes}, host_utime);
    input.Skip(num_bytes);
  }
  for (const voqcal::TimedSweep& sweep : stream.Finish()) sweep.Cloud(false);
  return 0;
}
