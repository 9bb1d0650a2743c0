// A table of features that another program extracted.
#include "result/poses_csv.hpp"

#include "fuzz/fuzz_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = voqcal::fuzz::AsFile({data, size}, "poses.csv");
  voqcal::BoardSpec board;
  board.width_m = 0.61;
  board.height_m = 0.85;
  board.square_m = 0.095;
  board.num_corners_x = 5;
  board.num_corners_y = 7;
  voqcal::fuzz::Tolerate([&] { voqcal::ReadPosesCsv(path, board); });
  return 0;
}
