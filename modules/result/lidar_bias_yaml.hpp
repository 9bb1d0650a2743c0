#pragma once

#include <filesystem>
#include <string>

#include "core/likelihood/lidar_bias.hpp"

namespace voqcal {

/// The section lidar_bias of extrinsic.yaml, with a line break at its end. Numbers read back
/// exactly; the standard error of what is unobservable is that of its prior, narrowed a little.
std::string LidarBiasYaml(const LidarBias& bias);

/// The values of such a section (not the standard errors); none if the file has no such section or
/// it says that they were not estimated.
/// @throws std::runtime_error naming file, line, key, rule and value.
LidarBias ReadLidarBias(const std::filesystem::path& path);

/// The result's chessboard_turn_rad; zero if the file has none.
/// @throws std::runtime_error naming file, line, key, rule and value.
Eigen::Vector2d ReadChessboardTurn(const std::filesystem::path& path);

}  // namespace voqcal
