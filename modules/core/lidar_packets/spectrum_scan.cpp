#include "core/lidar_packets/spectrum_scan.hpp"

#include <cmath>

#include "core/lidar_packets/packet_fields.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kHeaderBytesV1 = 8;
constexpr std::size_t kPointBytesV1 = 9;
constexpr std::size_t kNumPointsV1 = 160;
constexpr std::size_t kPacketBytesV1 = kHeaderBytesV1 + kNumPointsV1 * kPointBytesV1;
constexpr std::size_t kHeaderBytesV0 = 16;
constexpr std::size_t kPointBytesV0 = 20;
constexpr std::uint32_t kNoDistanceV1 = 0x7ffff;

double Wrapped(double angle_rad) {
  const double wrapped = std::fmod(angle_rad, 2 * M_PI);
  return wrapped < 0 ? wrapped + 2 * M_PI : wrapped;
}

PacketReturn ReturnAt(double theta_deg, double phi_deg, double distance_m) {
  const double azimuth_rad = (theta_deg - 90.0) * kRadPerDeg;
  const double elevation_rad = phi_deg * kRadPerDeg;
  PacketReturn result;
  result.azimuth_rad = Wrapped(theta_deg * kRadPerDeg);
  result.distance_m = distance_m;
  result.point.position_m =
      Eigen::Vector3d(distance_m * std::cos(elevation_rad) * std::cos(azimuth_rad),
                      distance_m * std::cos(elevation_rad) * std::sin(azimuth_rad),
                      distance_m * std::sin(elevation_rad))
          .cast<float>();
  return result;
}

LidarPacket DecodeV1(const std::uint8_t* data) {
  LidarPacket packet;
  packet.sensor_us = static_cast<std::int64_t>(ReadBig(data + 1, 4));
  const double tick_us = 8.0 * static_cast<double>(ReadBig(data + 5, 2)) / 1000.0;
  int num_ticks = 0;
  for (std::size_t i = 0; i < kNumPointsV1; ++i) {
    const std::uint8_t* point = data + kHeaderBytesV1 + i * kPointBytesV1;
    num_ticks += (point[0] - num_ticks) & 0xff;
    const double theta_deg = 0.01 * static_cast<double>(ReadBig(point + 1, 2));
    const std::uint64_t bits = ReadBig(point + 3, 6);
    const auto raw_phi = static_cast<int>(bits >> 33);
    const double phi_deg = 0.01 * (raw_phi < 0x4000 ? raw_phi : raw_phi - 0x8000);
    const auto distance_mm = static_cast<std::uint32_t>(bits >> 14 & 0x7ffff);
    if (distance_mm == kNoDistanceV1 || distance_mm == 0) continue;
    PacketReturn result = ReturnAt(theta_deg, phi_deg, 1e-3 * distance_mm);
    result.point.intensity = static_cast<float>(bits >> 6 & 0xff);
    result.after_packet_us = num_ticks * tick_us;
    result.number = (bits >> 1 & 1) != 0 ? 2 : 1;
    packet.returns.push_back(result);
  }
  return packet;
}

LidarPacket DecodeV0(const std::uint8_t* data, std::size_t num_points) {
  const auto read_angle_deg = [](const std::uint8_t* bytes) {
    return 1e-4 * static_cast<std::int32_t>(static_cast<std::uint32_t>(ReadBig(bytes, 4)));
  };
  LidarPacket packet;
  std::uint32_t first_us = 0;
  for (std::size_t i = 0; i < num_points; ++i) {
    const std::uint8_t* point = data + kHeaderBytesV0 + i * kPointBytesV0;
    const auto time_us = static_cast<std::uint32_t>(ReadBig(point, 4));
    const double theta_deg = read_angle_deg(point + 4);
    if (i == 0) packet.sensor_us = first_us = time_us;
    const auto distance_mm = static_cast<std::uint32_t>(ReadBig(point + 12, 4));
    if (distance_mm == 0) continue;
    PacketReturn result = ReturnAt(theta_deg, read_angle_deg(point + 8), 1e-3 * distance_mm);
    result.point.intensity = static_cast<float>(point[16]);
    result.after_packet_us = static_cast<std::int32_t>(time_us - first_us);
    packet.returns.push_back(result);
  }
  return packet;
}

}  // namespace

Expected<LidarPacket, PacketFault> DecodeSpectrumScan(PacketBytes bytes) {
  const std::uint8_t* const data = bytes.data;
  if (bytes.size >= kHeaderBytesV0 && data[0] == 0x44 && data[1] == 0x50) {
    const auto num_points = static_cast<std::size_t>(ReadBig(data + 14, 2));
    if (bytes.size != kHeaderBytesV0 + num_points * kPointBytesV0) return PacketFault::kWrongSize;
    if (num_points == 0) return PacketFault::kWithoutPoints;  // nor a time, which the points have
    return DecodeV0(data, num_points);
  }
  if (bytes.size != kPacketBytesV1) return PacketFault::kWrongSize;
  if (data[0] != 0x01) return PacketFault::kAlien;
  return DecodeV1(data);
}

PacketDecoder MakeSpectrumScan(const LidarUnit&) { return &DecodeSpectrumScan; }

}  // namespace voqcal
