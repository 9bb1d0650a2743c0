#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// One lidar return. What a cloud does not carry is stated in PointCloud, not guessed from values.
struct LidarPoint {
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();  ///< Lidar frame: x forward, y left, z up.
  float intensity = 0.0F;                                ///< The sensor's own scale.
  std::uint16_t ring = 0;                                ///< Scan line, counted from the lowest.
  std::uint8_t return_number = 0;                        ///< Among its beam's echoes.
  float time_s = 0.0F;                                   ///< After the cloud's utime.
};

/// One sweep, unorganised; points with NaN or at the origin stand for beams without a return.
struct PointCloud {
  std::vector<LidarPoint> points;
  bool has_intensity = false;
  bool has_ring = false;
  bool has_return_number = false;
  bool has_time = false;
};

}  // namespace voqcal
