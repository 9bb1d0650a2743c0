// First byte: PCD or PLY. Then the file.
#include "files/point_cloud_file.hpp"
#include "fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  voqcal::fuzz::Input input(data, size);
  const bool is_ply = input.Byte() % 2 == 1;
  const auto path = voqcal::fuzz::AsFile(input, is_ply ? "cloud.ply" : "cloud.pcd");
  voqcal::fuzz::Tolerate([&path] { voqcal::ReadPointCloud(path); });
  return 0;
}
