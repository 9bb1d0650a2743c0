// A result: its transform, then its lidar_bias.
#include "fuzz/fuzz_input.hpp"
#include "result/lidar_bias_yaml.hpp"
#include "result/result_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = voqcal::fuzz::AsFile({data, size}, "extrinsic.yaml");
  voqcal::fuzz::Tolerate([&path] { voqcal::ReadExtrinsic(path); });
  voqcal::fuzz::Tolerate([&path] { voqcal::ReadLidarBias(path); });
  return 0;
}
