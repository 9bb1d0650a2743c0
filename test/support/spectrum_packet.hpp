#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace voqcal::test {

inline void WriteBig(std::uint64_t value, int num_bytes, std::vector<std::uint8_t>* bytes) {
  for (int i = num_bytes - 1; i >= 0; --i) {
    bytes->push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

/// One point as a packet says it.
struct SpectrumPoint {
  int ticks = 0;  // of 8 * cycle / 1000 us
  double theta_deg = 90.0;
  double phi_deg = 0.0;
  std::uint32_t distance_mm = 0x7ffff;
  int intensity = 0;
};

/// A packet of version 1 as its layout is described.
inline std::vector<std::uint8_t> SpectrumVersionOne(std::uint32_t base_us,
                                                    int cycle,
                                                    std::vector<SpectrumPoint> points) {
  points.resize(160);
  std::vector<std::uint8_t> bytes{0x01};
  WriteBig(base_us, 4, &bytes);
  WriteBig(static_cast<std::uint64_t>(cycle), 2, &bytes);
  bytes.push_back(0);
  for (const SpectrumPoint& point : points) {
    bytes.push_back(static_cast<std::uint8_t>(point.ticks & 0xff));
    WriteBig(static_cast<std::uint64_t>(std::lround(point.theta_deg * 100)), 2, &bytes);
    const auto phi = static_cast<std::uint64_t>(std::lround(point.phi_deg * 100)) & 0x7fff;
    const auto intensity = static_cast<std::uint64_t>(point.intensity);
    WriteBig(
        phi << 33 | std::uint64_t{point.distance_mm} << 14 | intensity << 6 | 3U << 2, 6, &bytes);
  }
  return bytes;
}

/// The same of version 0.
inline std::vector<std::uint8_t> SpectrumVersionZero(std::uint32_t time_us,
                                                     const std::vector<SpectrumPoint>& points) {
  std::vector<std::uint8_t> bytes{0x44, 0x50};
  bytes.resize(14, 0);
  WriteBig(points.size(), 2, &bytes);
  for (const SpectrumPoint& point : points) {
    WriteBig(time_us + static_cast<std::uint32_t>(point.ticks), 4, &bytes);
    for (const double angle_deg : {point.theta_deg, point.phi_deg}) {
      WriteBig(static_cast<std::uint32_t>(std::lround(angle_deg * 1e4)), 4, &bytes);
    }
    WriteBig(point.distance_mm, 4, &bytes);
    bytes.push_back(static_cast<std::uint8_t>(point.intensity));
    WriteBig(0, 3, &bytes);
  }
  return bytes;
}

}  // namespace voqcal::test
