#include "decode_lidar/sweep_pcd.hpp"

#include <cstdint>
#include <cstring>

namespace voqcal {
namespace {

template <typename T>
void Append(T value, std::string* bytes) {
  char buffer[sizeof(T)];
  std::memcpy(buffer, &value, sizeof(T));
  bytes->append(buffer, sizeof(T));
}

}  // namespace

std::string SweepPcd(const TimedSweep& sweep) {
  const std::string num_points = std::to_string(sweep.returns.size());
  std::string bytes = "# utime " + std::to_string(sweep.utime) +
                      "\nVERSION 0.7\n"
                      "FIELDS x y z intensity ring time return_number\n"
                      "SIZE 4 4 4 4 2 4 1\nTYPE F F F F U F U\nCOUNT 1 1 1 1 1 1 1\nWIDTH " +
                      num_points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + num_points +
                      "\nDATA binary\n";
  for (const PacketReturn& echo : sweep.returns) {
    for (int axis = 0; axis < 3; ++axis) Append(echo.point.position_m[axis], &bytes);
    Append(echo.point.intensity, &bytes);
    Append(echo.point.ring, &bytes);
    Append(echo.point.time_s, &bytes);
    Append(static_cast<std::uint8_t>(echo.number), &bytes);
  }
  return bytes;
}

}  // namespace voqcal
