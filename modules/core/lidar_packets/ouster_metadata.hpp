#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace voqcal {

/// What a sensor of Ouster's says of itself.
struct OusterMetadata {
  std::string profile;  ///< Of its lidar packets: "LEGACY", "RNG19_RFL8_SIG16_NIR16", ...
  int num_pixels = 0;   ///< Lines; a column of a packet has so many.
  int columns_of_packet = 0;
  int columns_of_turn = 0;
  std::vector<double> altitudes_rad;       ///< By pixel, from the top.
  std::vector<double> azimuths_rad;        ///< By pixel, added to the encoder's.
  Eigen::Vector3d beam_origin_m{0, 0, 0};  ///< From the axis, at encoder angle 0.
  Eigen::Isometry3d T_sensor_lidar = Eigen::Isometry3d::Identity();
  std::uint64_t serial_number = 0;  ///< 0: not said.
};

/// Reads the metadata as the sensor gives it, flat (legacy) or in sections.
/// @throws std::invalid_argument naming key, rule and value.
OusterMetadata ReadOusterMetadata(const std::string& json);

}  // namespace voqcal
