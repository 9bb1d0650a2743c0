#include "core/lidar_packets/ouster.hpp"

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/lidar_packets/beam_table.hpp"
#include "core/lidar_packets/ouster_metadata.hpp"
#include "core/lidar_packets/packet_fields.hpp"

namespace voqcal {
namespace {

// One echo of a pixel: where its range and its reflectivity are.
struct EchoFields {
  std::size_t range;
  int range_bytes;
  std::uint32_t range_mask;
  int range_shift;  // to the left, to millimetres
  std::size_t reflectivity;
};

// How a profile's packets are laid out.
struct Profile {
  std::size_t header_bytes;  // of the packet
  std::size_t column_header_bytes;
  std::size_t column_footer_bytes;
  std::size_t packet_footer_bytes;
  std::size_t pixel_bytes;
  std::vector<EchoFields> echoes;
  bool is_legacy = false;     // frame and state with each column, not in a header
  std::size_t frame_at = 2;   // in the packet's header, 16 bits
  std::size_t serial_at = 7;  // in the packet's header, 40 bits
};

constexpr std::uint32_t k19Bits = 0x7FFFF;
constexpr std::uint32_t k15Bits = 0x7FFF;

const std::map<std::string, Profile>& Profiles() {
  static const std::map<std::string, Profile> profiles = {
      {"LEGACY", {0, 16, 4, 0, 12, {{0, 4, 0xFFFFF, 0, 4}}, true}},
      {"RNG19_RFL8_SIG16_NIR16", {32, 12, 0, 32, 12, {{0, 4, k19Bits, 0, 4}}}},
      {"RNG19_RFL8_SIG16_NIR16_DUAL",
       {32, 12, 0, 32, 16, {{0, 4, k19Bits, 0, 3}, {4, 4, k19Bits, 0, 7}}}},
      {"RNG15_RFL8_NIR8", {32, 12, 0, 32, 4, {{0, 2, k15Bits, 3, 2}}}},
      {"RNG15_RFL8_NIR8_DUAL", {32, 12, 0, 32, 8, {{0, 2, k15Bits, 3, 2}, {4, 2, k15Bits, 3, 6}}}},
      {"FUSA_RNG15_RFL8_NIR8_DUAL",
       {32, 12, 0, 32, 8, {{0, 2, k15Bits, 3, 2}, {4, 2, k15Bits, 3, 6}}, false, 4, 11}},
  };
  return profiles;
}

const Profile& ProfileNamed(const std::string& name) {
  const auto known = Profiles().find(name);
  if (known != Profiles().end()) return known->second;
  std::string names;
  for (const auto& [other, profile] : Profiles()) names += (names.empty() ? "" : ", ") + other;
  throw std::invalid_argument("udp_profile_lidar must be one of " + names + ", is " + name);
}

class Decoder {
 public:
  explicit Decoder(OusterMetadata metadata)
      : metadata_(std::move(metadata)), profile_(ProfileNamed(metadata_.profile)) {
    BeamTable beams(metadata_.altitudes_rad.size());
    for (std::size_t i = 0; i < beams.size(); ++i) {
      beams[i].elevation_rad = metadata_.altitudes_rad[i];
    }
    NumberRings(&beams);
    for (const Beam& beam : beams) rings_.push_back(static_cast<std::uint16_t>(beam.ring));
  }

  Expected<LidarPacket, PacketFault> Decode(PacketBytes bytes) const {
    constexpr std::size_t kMotionBytes = 48;
    if (bytes.size == kMotionBytes) return PacketFault::kWithoutPoints;
    if (bytes.size != PacketSize()) return PacketFault::kWrongSize;
    if (!IsOurs(bytes.data)) return PacketFault::kAlien;
    LidarPacket packet;
    packet.frame =
        Read16(profile_.is_legacy ? Column(bytes.data, 0) + 10 : bytes.data + profile_.frame_at);
    std::int64_t first_ns = 0;
    for (int i = 0; i < metadata_.columns_of_packet; ++i) {
      const std::uint8_t* const column = Column(bytes.data, i);
      if (!IsValid(column) || Read16(column + 8) >= metadata_.columns_of_turn) continue;
      const auto time_ns = static_cast<std::int64_t>(ReadLittle(column, 8) & kMaxTimeNs);
      if (first_ns == 0) {
        first_ns = time_ns;
        packet.sensor_us = time_ns / 1000;
      }
      AppendColumn(column, 1e-3 * static_cast<double>(time_ns - packet.sensor_us * 1000), &packet);
    }
    if (first_ns == 0) return PacketFault::kWithoutPoints;
    return packet;
  }

 private:
  static constexpr std::uint64_t kMaxTimeNs = (std::uint64_t{1} << 62) - 1;

  std::size_t ColumnBytes() const {
    return profile_.column_header_bytes + metadata_.num_pixels * profile_.pixel_bytes +
           profile_.column_footer_bytes;
  }
  std::size_t PacketSize() const {
    return profile_.header_bytes + metadata_.columns_of_packet * ColumnBytes() +
           profile_.packet_footer_bytes;
  }
  const std::uint8_t* Column(const std::uint8_t* data, int i) const {
    return data + profile_.header_bytes + i * ColumnBytes();
  }

  // Two sensors may send to one port.
  bool IsOurs(const std::uint8_t* data) const {
    if (profile_.is_legacy) return true;
    const std::uint64_t serial = ReadLittle(data + profile_.serial_at, 5);
    return data[0] == 1 &&
           (serial == 0 || metadata_.serial_number == 0 || serial == metadata_.serial_number);
  }

  bool IsValid(const std::uint8_t* column) const {
    if (!profile_.is_legacy) return (column[10] & 1) != 0;
    return Read32(column + ColumnBytes() - profile_.column_footer_bytes) == 0xFFFFFFFFU;
  }

  void AppendColumn(const std::uint8_t* column, double after_packet_us, LidarPacket* packet) const {
    const double turned_rad = 2 * M_PI * Read16(column + 8) / metadata_.columns_of_turn;
    for (int pixel = 0; pixel < metadata_.num_pixels; ++pixel) {
      const std::uint8_t* const data =
          column + profile_.column_header_bytes + pixel * profile_.pixel_bytes;
      BeamEchoes echoes;
      for (const EchoFields& fields : profile_.echoes) {
        const auto raw =
            static_cast<std::uint32_t>(ReadLittle(data + fields.range, fields.range_bytes));
        echoes.Add({static_cast<int>((raw & fields.range_mask) << fields.range_shift),
                    data[fields.reflectivity]});
      }
      for (int i = 0; i < echoes.size(); ++i) {
        PacketReturn echo = Measured(pixel, turned_rad, 1e-3 * echoes[i].distance);
        echo.point.intensity = static_cast<float>(echoes[i].intensity);
        echo.after_packet_us = after_packet_us;
        echo.number = i + 1;
        echo.of_how_many = echoes.size();
        packet->returns.push_back(echo);
      }
    }
  }

  // The manual's "Lidar Range to XYZ": the range counts from the axis to the beam's origin, and
  // from there along the beam.
  PacketReturn Measured(int pixel, double turned_rad, double range_m) const {
    const double encoder_rad = -turned_rad;
    const double azimuth_rad = encoder_rad - metadata_.azimuths_rad[pixel];
    const double altitude_rad = metadata_.altitudes_rad[pixel];
    const Eigen::Vector3d& origin_m = metadata_.beam_origin_m;
    const double along_m = range_m - std::hypot(origin_m.x(), origin_m.z());
    const Eigen::Vector3d point_lidar_m(along_m * std::cos(azimuth_rad) * std::cos(altitude_rad) +
                                            origin_m.x() * std::cos(encoder_rad),
                                        along_m * std::sin(azimuth_rad) * std::cos(altitude_rad) +
                                            origin_m.x() * std::sin(encoder_rad),
                                        along_m * std::sin(altitude_rad) + origin_m.z());
    PacketReturn result;
    result.point.position_m = (metadata_.T_sensor_lidar * point_lidar_m).cast<float>();
    result.point.ring = rings_[pixel];
    result.azimuth_rad = turned_rad;
    result.distance_m = range_m;
    return result;
  }

  OusterMetadata metadata_;
  Profile profile_;
  std::vector<std::uint16_t> rings_;  // by pixel
};

}  // namespace

PacketDecoder MakeOuster(const LidarUnit& unit) {
  return [decoder = Decoder(ReadOusterMetadata(unit.calibration))](PacketBytes bytes) {
    return decoder.Decode(bytes);
  };
}

}  // namespace voqcal
