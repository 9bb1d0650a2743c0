// A capture file, read to its end as the lidar driver does.
#include <spdlog/spdlog.h>

#include "fuzz/fuzz_input.hpp"
#include "lidar_driver/packet_lidar_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  spdlog::set_level(spdlog::level::off);
  voqcal::LidarSensorOptions options;
  options.pcap = voqcal::fuzz::AsFile({data, size}, "capture.pcap");
  voqcal::fuzz::Tolerate([&options] {
    voqcal::PacketLidarSource source(options, {});
    while (!source.HasEnded()) source.Next();
    source.Counts();
  });
  return 0;
}
