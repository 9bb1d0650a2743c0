#include "core/lidar/vlp16.hpp"

#include <cmath>

namespace voqcal {
namespace {

constexpr double kRadPerDeg = M_PI / 180.0;
constexpr int kNumRings = 16;
constexpr int kNumBlocks = 12;
constexpr std::size_t kBlockBytes = 100;
constexpr int kNumFirings = 2;  // of all lasers, in each block
constexpr std::size_t kPacketBytes = 1206;
constexpr double kLaserUs = 2.304;
constexpr double kFiringUs = 55.296;
constexpr double kBlockUs = kNumFirings * kFiringUs;
constexpr double kUnitM = 0.002;
constexpr int kTurn = 36000;  // centidegrees
constexpr std::uint8_t kStrongest = 0x37;
constexpr std::uint8_t kLast = 0x38;
constexpr std::uint8_t kDual = 0x39;
constexpr std::uint8_t kProductVlp16 = 0x22;

struct Echo {
  int distance = 0;  // in 2 mm
  int intensity = 0;
  bool operator==(const Echo& other) const {
    return distance == other.distance && intensity == other.intensity;
  }
};

// Little-endian fields of a packet of the right size.
class View {
 public:
  explicit View(PacketBytes bytes) : data_(bytes.data) {}

  bool HasFlags() const {
    for (int block = 0; block < kNumBlocks; ++block) {
      const std::uint8_t* begin = data_ + block * kBlockBytes;
      if (begin[0] != 0xFF || begin[1] != 0xEE || Azimuth(block) >= kTurn) return false;
    }
    return true;
  }
  int Azimuth(int block) const { return Read16(block * kBlockBytes + 2); }  // centidegrees
  Echo EchoOf(int block, int firing, int laser) const {
    const std::size_t at = block * kBlockBytes + 4 + 3 * (kNumRings * firing + laser);
    return {Read16(at), data_[at + 2]};
  }
  std::uint32_t TimeUs() const {
    return static_cast<std::uint32_t>(Read16(1200)) | static_cast<std::uint32_t>(Read16(1202))
                                                          << 16;
  }
  std::uint8_t Mode() const { return data_[1204]; }
  std::uint8_t Product() const { return data_[1205]; }

 private:
  int Read16(std::size_t at) const { return data_[at] | data_[at + 1] << 8; }

  const std::uint8_t* data_;
};

// Lasers are numbered from the top and from the bottom half in turn: -15 1 -13 3 ... degrees.
int RingOf(int laser) { return laser % 2 == 0 ? laser / 2 : kNumRings / 2 + laser / 2; }

double ElevationRad(int ring, const Vlp16Options& options) {
  return options.elevations_rad.empty() ? (2.0 * ring - 15.0) * kRadPerDeg
                                        : options.elevations_rad[ring];
}

// How far the head turns during block `block`, centidegrees; `step` blocks share an azimuth. The
// last takes the one before as its measure.
int Advance(const View& view, int block, int step) {
  const int from = block + step < kNumBlocks ? block : block - step;
  return (view.Azimuth(from + step) - view.Azimuth(from) + kTurn) % kTurn;
}

PacketReturn ReturnOf(const Echo& echo, int ring, double azimuth_rad, const Vlp16Options& options) {
  PacketReturn result;
  result.distance_m = kUnitM * echo.distance;
  result.azimuth_rad = azimuth_rad;
  const double offset_m = options.distance_offset_m +
                          (options.ring_offsets_m.empty() ? 0.0 : options.ring_offsets_m[ring]);
  const double range_m = result.distance_m - offset_m;
  const double elevation_rad = ElevationRad(ring, options);
  result.point.position_m =
      Eigen::Vector3d(range_m * std::cos(elevation_rad) * std::cos(azimuth_rad),
                      -range_m * std::cos(elevation_rad) * std::sin(azimuth_rad),
                      range_m * std::sin(elevation_rad))
          .cast<float>();
  result.point.intensity = static_cast<float>(echo.intensity);
  result.point.ring = static_cast<std::uint16_t>(ring);
  return result;
}

void AppendReturns(const View& view,
                   int block,
                   bool is_dual,
                   const Vlp16Options& options,
                   std::vector<PacketReturn>* returns) {
  const int step = is_dual ? 2 : 1;
  const int advance = Advance(view, block, step);
  const double block_us = block / step * kBlockUs;
  for (int firing = 0; firing < kNumFirings; ++firing) {
    for (int laser = 0; laser < kNumRings; ++laser) {
      const double in_block_us = firing * kFiringUs + laser * kLaserUs;
      const double turned = view.Azimuth(block) + advance * in_block_us / kBlockUs;
      const double azimuth_rad = std::fmod(turned, kTurn) * 0.01 * kRadPerDeg;
      const auto append = [&](const Echo& echo, ReturnKind kind) {
        if (echo.distance == 0) return;
        returns->push_back(ReturnOf(echo, RingOf(laser), azimuth_rad, options));
        returns->back().after_packet_us = block_us + in_block_us;
        returns->back().kind = kind;
      };
      const Echo first = view.EchoOf(block, firing, laser);
      const Echo second = is_dual ? view.EchoOf(block + 1, firing, laser) : first;
      const bool is_one = first == second || first.distance == 0 || second.distance == 0;
      append(first.distance == 0 ? second : first, is_one ? ReturnKind::kOnly : ReturnKind::kLast);
      if (!is_one) append(second, ReturnKind::kOther);
    }
  }
}

}  // namespace

std::vector<std::string> Vlp16Options::Problems() const {
  std::vector<std::string> problems;
  const auto require_one_a_ring = [&problems](const char* name, const std::vector<double>& list) {
    if (list.empty() || list.size() == kNumRings) return;
    problems.push_back(std::string(name) + " must have 16 entries or none, has " +
                       std::to_string(list.size()));
  };
  require_one_a_ring("elevations_deg", elevations_rad);
  require_one_a_ring("ring_offsets_m", ring_offsets_m);
  for (const double elevation_rad : elevations_rad) {
    if (std::abs(elevation_rad) < M_PI / 2) continue;
    problems.push_back("elevations_deg must be within -90 and 90, one is " +
                       std::to_string(elevation_rad / kRadPerDeg));
  }
  return problems;
}

Expected<LidarPacket, PacketFault> DecodeVlp16(PacketBytes bytes, const Vlp16Options& options) {
  if (bytes.size != kPacketBytes) return PacketFault::kWrongSize;
  const View view(bytes);
  if (!view.HasFlags() || view.Product() != kProductVlp16 || view.TimeUs() >= kVlp16ClockUs) {
    return PacketFault::kAlien;
  }
  const bool is_dual = view.Mode() == kDual;
  if (!is_dual && view.Mode() != kStrongest && view.Mode() != kLast) {
    return PacketFault::kUnknownMode;
  }
  LidarPacket packet;
  packet.sensor_us = view.TimeUs();
  packet.is_dual = is_dual;
  for (int block = 0; block < kNumBlocks; block += is_dual ? 2 : 1) {
    AppendReturns(view, block, is_dual, options, &packet.returns);
  }
  return packet;
}

}  // namespace voqcal
