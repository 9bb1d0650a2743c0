#include "core/lidar_packets/ouster_metadata.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include <yaml-cpp/yaml.h>

#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kMPerMm = 1e-3;

std::invalid_argument Bad(const std::string& key, const std::string& rule) {
  return std::invalid_argument(key + " must be " + rule);
}

// A key of a section of the newer layout, or of the top level of the older.
YAML::Node Find(const YAML::Node& root, const char* section, const char* key) {
  const YAML::Node within = root[section];
  if (within && within.IsMap() && within[key]) return within[key];
  return root[key];
}

std::vector<double> Numbers(const YAML::Node& node, const std::string& key, std::size_t count) {
  const std::string rule = "a list of " + std::to_string(count) + " numbers";
  if (!node || !node.IsSequence() || node.size() != count) throw Bad(key, rule);
  auto numbers = node.as<std::vector<double>>();
  for (const double number : numbers) {
    if (!std::isfinite(number)) throw Bad(key, rule);
  }
  return numbers;
}

int Count(const YAML::Node& node, const std::string& key, int most) {
  const int count = node ? node.as<int>() : 0;
  if (count < 1 || count > most) throw Bad(key, "1 to " + std::to_string(most));
  return count;
}

// "1024x10": columns of a turn, turns a second.
int ColumnsOfMode(const YAML::Node& node) {
  const int columns = node ? std::atoi(node.as<std::string>().c_str()) : 0;
  if (columns < 1 || columns > 8192) throw Bad("lidar_mode", "as \"1024x10\"");
  return columns;
}

// The format's numbers; the firmware before 1.14 had one format, and did not say it.
void ReadFormat(const YAML::Node& root, OusterMetadata* metadata) {
  const bool is_nested = root["lidar_data_format"] && root["lidar_data_format"].IsMap();
  const YAML::Node format = is_nested ? root["lidar_data_format"] : root["data_format"];
  if (!format || !format.IsMap()) {
    metadata->num_pixels = 64;
    metadata->columns_of_packet = 16;
    metadata->columns_of_turn = ColumnsOfMode(Find(root, "config_params", "lidar_mode"));
    metadata->profile = "LEGACY";
    return;
  }
  metadata->num_pixels = Count(format["pixels_per_column"], "pixels_per_column", 256);
  metadata->columns_of_packet = Count(format["columns_per_packet"], "columns_per_packet", 64);
  metadata->columns_of_turn = Count(format["columns_per_frame"], "columns_per_frame", 8192);
  const YAML::Node profile = format["udp_profile_lidar"];
  metadata->profile = profile ? profile.as<std::string>() : "LEGACY";
}

void ReadBeams(const YAML::Node& root, OusterMetadata* metadata) {
  const auto radians = [&](const char* key) {
    auto angles = Numbers(
        Find(root, "beam_intrinsics", key), key, static_cast<std::size_t>(metadata->num_pixels));
    for (double& angle : angles) angle *= kRadPerDeg;
    return angles;
  };
  metadata->altitudes_rad = radians("beam_altitude_angles");
  metadata->azimuths_rad = radians("beam_azimuth_angles");
  const YAML::Node transform = Find(root, "beam_intrinsics", "beam_to_lidar_transform");
  const YAML::Node offset = Find(root, "beam_intrinsics", "lidar_origin_to_beam_origin_mm");
  if (transform) {
    const auto values = Numbers(transform, "beam_to_lidar_transform", 16);
    metadata->beam_origin_m = kMPerMm * Eigen::Vector3d(values[3], values[7], values[11]);
  } else {
    constexpr double kUsualMm = 12.163;  // of the first OS-1, whose firmware does not say it
    metadata->beam_origin_m.x() = kMPerMm * (offset ? offset.as<double>() : kUsualMm);
  }
}

void ReadFrame(const YAML::Node& root, OusterMetadata* metadata) {
  const YAML::Node transform = Find(root, "lidar_intrinsics", "lidar_to_sensor_transform");
  const auto values = transform ? Numbers(transform, "lidar_to_sensor_transform", 16)
                                : std::vector<double>{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      metadata->T_sensor_lidar.linear()(row, column) = values[4 * row + column];
    }
    metadata->T_sensor_lidar.translation()(row) = kMPerMm * values[4 * row + 3];
  }
}

}  // namespace

OusterMetadata ReadOusterMetadata(const std::string& json) try {
  const YAML::Node root = YAML::Load(json);
  if (!root.IsMap()) throw std::invalid_argument("must be the sensor's metadata, a JSON object");
  OusterMetadata metadata;
  ReadFormat(root, &metadata);
  ReadBeams(root, &metadata);
  ReadFrame(root, &metadata);
  const YAML::Node serial = Find(root, "sensor_info", "prod_sn");
  if (serial) metadata.serial_number = std::strtoull(serial.as<std::string>().c_str(), nullptr, 10);
  return metadata;
} catch (const YAML::Exception& error) {
  throw std::invalid_argument(std::string("is not a sensor's metadata as JSON: ") + error.what());
}

}  // namespace voqcal
