#include "core/lidar_packets/livox.hpp"

#include <cmath>
#include <optional>

#include "core/lidar_packets/packet_fields.hpp"

namespace voqcal {
namespace {

// How a kind of packet has its points.
struct Kind {
  bool is_spherical;     // depth, then angles that all its returns share
  int coordinate_bytes;  // of x, y, z
  double unit_m;
  std::size_t echo_bytes;  // of one return
  int num_returns;
};

double Signed(const std::uint8_t* bytes, int num_bytes) {
  const std::uint64_t value = ReadLittle(bytes, num_bytes);
  return num_bytes == 2 ? static_cast<std::int16_t>(value) : static_cast<std::int32_t>(value);
}

PacketReturn PointAt(const Eigen::Vector3d& position_m, int reflectivity) {
  PacketReturn result;
  result.point.position_m = position_m.cast<float>();
  result.point.intensity = static_cast<float>(reflectivity);
  result.distance_m = position_m.norm();
  return result;
}

// theta from the zenith, phi counter-clockwise from x; both in 0.01 degrees.
Eigen::Vector3d Direction(const std::uint8_t* angles) {
  constexpr double kRadPerUnit = 0.01 * M_PI / 180.0;
  const double theta_rad = Read16(angles) * kRadPerUnit;
  const double phi_rad = Read16(angles + 2) * kRadPerUnit;
  return {std::sin(theta_rad) * std::cos(phi_rad),
          std::sin(theta_rad) * std::sin(phi_rad),
          std::cos(theta_rad)};
}

std::size_t PointBytes(const Kind& kind) {
  // One spherical return has its depth before its angles; several have the angles first.
  return kind.is_spherical && kind.num_returns > 1 ? 4 + kind.num_returns * kind.echo_bytes
                                                   : kind.num_returns * kind.echo_bytes;
}

// What one beam saw: its returns that are there, the nearest first as they come.
void AppendPoint(const std::uint8_t* data,
                 const Kind& kind,
                 double after_packet_us,
                 std::vector<PacketReturn>* returns) {
  const std::size_t first = returns->size();
  const bool are_angles_first = kind.is_spherical && kind.num_returns > 1;
  for (int i = 0; i < kind.num_returns; ++i) {
    const std::uint8_t* const echo = data + (are_angles_first ? 4 : 0) + i * kind.echo_bytes;
    Eigen::Vector3d position_m;
    int reflectivity = 0;
    if (kind.is_spherical) {
      const double depth_m = kind.unit_m * Read32(echo);
      position_m = depth_m * Direction(are_angles_first ? data : echo + 4);
      reflectivity = echo[are_angles_first ? 4 : 8];
    } else {
      for (int axis = 0; axis < 3; ++axis) {
        position_m[axis] =
            kind.unit_m * Signed(echo + axis * kind.coordinate_bytes, kind.coordinate_bytes);
      }
      reflectivity = echo[3 * kind.coordinate_bytes];
    }
    if (position_m.isZero(0.0)) continue;
    returns->push_back(PointAt(position_m, reflectivity));
    returns->back().after_packet_us = after_packet_us;
  }
  const auto num_echoes = static_cast<int>(returns->size() - first);
  for (int i = 0; i < num_echoes; ++i) {
    (*returns)[first + i].number = i + 1;
    (*returns)[first + i].of_how_many = num_echoes;
  }
}

void AppendPoints(const std::uint8_t* data,
                  const Kind& kind,
                  std::size_t num_points,
                  double step_us,
                  LidarPacket* packet) {
  for (std::size_t i = 0; i < num_points; ++i) {
    AppendPoint(
        data + i * PointBytes(kind), kind, step_us * static_cast<double>(i), &packet->returns);
  }
}

// Nanoseconds; a clock that is not one reads as one that does not move.
std::int64_t TimeUs(const std::uint8_t* bytes) {
  constexpr std::uint64_t kMaxNs = std::uint64_t{1} << 62;
  return static_cast<std::int64_t>(ReadLittle(bytes, 8) % kMaxNs / 1000);
}

Expected<LidarPacket, PacketFault> DecodeSdk2(PacketBytes bytes) {
  constexpr std::size_t kHeader = 36;
  if (bytes.size < kHeader) return PacketFault::kWrongSize;
  const std::uint8_t* const data = bytes.data;
  if (data[0] != 0 || static_cast<std::size_t>(Read16(data + 1)) != bytes.size) {
    return PacketFault::kAlien;
  }
  constexpr std::uint8_t kMotion = 0;
  std::optional<Kind> kind;
  if (data[10] == kMotion) return PacketFault::kWithoutPoints;
  if (data[10] == 1) kind = Kind{false, 4, 1e-3, 14, 1};
  if (data[10] == 2) kind = Kind{false, 2, 1e-2, 8, 1};
  if (data[10] == 3) kind = Kind{true, 0, 1e-3, 10, 1};
  if (!kind) return PacketFault::kUnknownMode;
  const auto num_points = static_cast<std::size_t>(Read16(data + 5));
  if (num_points == 0) return PacketFault::kWithoutPoints;
  if (bytes.size != kHeader + num_points * PointBytes(*kind)) return PacketFault::kWrongSize;
  LidarPacket packet;
  packet.sensor_us = TimeUs(data + 28);
  const double step_us = 0.1 * Read16(data + 3) / static_cast<double>(num_points);
  AppendPoints(data + kHeader, *kind, num_points, step_us, &packet);
  return packet;
}

Expected<LidarPacket, PacketFault> DecodeSdk1(PacketBytes bytes) {
  constexpr std::size_t kHeader = 18;
  constexpr std::uint8_t kVersion = 5;
  constexpr std::uint8_t kMotion = 6;
  // By data_type; the first two are the Mid-40's, 10 us apart, the others 240,000 a second.
  constexpr Kind kKinds[] = {{false, 4, 1e-3, 13, 1},
                             {true, 0, 1e-3, 9, 1},
                             {false, 4, 1e-3, 14, 1},
                             {true, 0, 1e-3, 10, 1},
                             {false, 4, 1e-3, 14, 2},
                             {true, 0, 1e-3, 6, 2},
                             {},
                             {false, 4, 1e-3, 14, 3},
                             {true, 0, 1e-3, 6, 3}};
  constexpr std::size_t kCounts[] = {100, 100, 96, 96, 48, 48, 0, 30, 30};
  if (bytes.size < kHeader) return PacketFault::kWrongSize;
  if (bytes.data[0] != kVersion) return PacketFault::kAlien;
  const std::uint8_t type = bytes.data[9];
  if (type == kMotion) return PacketFault::kWithoutPoints;
  if (type >= std::size(kKinds)) return PacketFault::kUnknownMode;
  const Kind& kind = kKinds[type];
  if (bytes.size != kHeader + kCounts[type] * PointBytes(kind)) return PacketFault::kWrongSize;
  LidarPacket packet;
  packet.sensor_us = TimeUs(bytes.data + 10);
  AppendPoints(bytes.data + kHeader, kind, kCounts[type], type < 2 ? 10.0 : 1e6 / 240000, &packet);
  return packet;
}

}  // namespace

PacketDecoder MakeLivoxMid360(const LidarUnit&) { return &DecodeSdk2; }
PacketDecoder MakeLivoxAvia(const LidarUnit&) { return &DecodeSdk1; }

}  // namespace voqcal
