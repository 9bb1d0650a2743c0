#include "core/lidar_packets/robosense.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "core/lidar_packets/beam_table.hpp"
#include "core/lidar_packets/packet_fields.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr int kTurn = 36000;  // centidegrees
constexpr std::size_t kPacketBytes = 1248;
constexpr std::size_t kHeaderBytes = 42;
constexpr std::size_t kTimeAt = 20;
constexpr std::size_t kBlockBytes = 100;
constexpr int kNumBlocks = 12;
constexpr int kNumChannels = 32;  // of a block

constexpr std::uint8_t kStateMark[] = {0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
constexpr std::size_t kReturnModeAt = 300;  // in state packets
constexpr std::size_t kAnglesAt = 468;  // elevations, then azimuths: sign, 2 bytes of 0.01 degrees
constexpr std::size_t kAngles16At = 1165;  // elevations alone: 3 bytes of 1e-4 degrees

// What tells one model from another.
struct Model {
  std::vector<std::uint8_t> mark;  // with which data packets begin
  int num_lasers;
  double unit_m;         // of distance
  bool has_utc_seconds;  // else date and time of day
  double firing_us;      // from a firing of all lasers to the next
  double (*laser_us)(int laser);
  double lens_m;    // of the beams' origins from the axis, ahead
  BeamTable beams;  // empty: not known yet
};

std::int64_t TimeUs(const std::uint8_t* time, bool has_utc_seconds) {
  if (has_utc_seconds) {
    constexpr std::uint64_t kMaxSeconds = 1000000000000;
    return static_cast<std::int64_t>(std::min(ReadBig(time, 6), kMaxSeconds) * 1000000 +
                                     ReadBig(time + 6, 4));
  }
  std::tm parts{};
  parts.tm_year = time[0] + 100;
  parts.tm_mon = time[1] - 1;
  parts.tm_mday = time[2];
  parts.tm_hour = time[3];
  parts.tm_min = time[4];
  parts.tm_sec = time[5];
  return std::int64_t{timegm(&parts)} * 1000000 +
         static_cast<std::int64_t>(ReadBig(time + 6, 2) * 1000 + ReadBig(time + 8, 2));
}

class Decoder {
 public:
  Decoder(Model model, LidarUnit unit)
      : model_(std::move(model)),
        unit_(std::move(unit)),
        has_own_angles_(!unit_.calibration.empty()) {
    if (has_own_angles_) {
      const auto num_lasers = static_cast<std::size_t>(model_.num_lasers);
      model_.beams = ReadBeamCsv(unit_.calibration, num_lasers);
    }
    CompleteBeams(&model_.beams);
  }

  Expected<LidarPacket, PacketFault> Decode(PacketBytes bytes) {
    if (bytes.size != kPacketBytes) return PacketFault::kWrongSize;
    if (std::equal(std::begin(kStateMark), std::end(kStateMark), bytes.data)) {
      LearnState(bytes.data);
      return PacketFault::kWithoutPoints;
    }
    if (!IsOurs(bytes.data)) return PacketFault::kAlien;
    if (model_.beams.empty()) return PacketFault::kWithoutCalibration;
    LidarPacket packet;
    packet.sensor_us = TimeUs(bytes.data + kTimeAt, model_.has_utc_seconds);
    const int num_copies = AreBlocksInPairs(bytes.data) ? 2 : 1;
    for (int block = 0; block < kNumBlocks; block += num_copies) {
      AppendGroup(bytes.data, block, num_copies, &packet.returns);
    }
    return packet;
  }

 private:
  static const std::uint8_t* Block(const std::uint8_t* data, int block) {
    return data + kHeaderBytes + block * kBlockBytes;
  }
  static int Azimuth(const std::uint8_t* data, int block) {
    return static_cast<int>(ReadBig(Block(data, block) + 2, 2));
  }

  bool IsOurs(const std::uint8_t* data) const {
    if (!std::equal(model_.mark.begin(), model_.mark.end(), data)) return false;
    for (int block = 0; block < kNumBlocks; ++block) {
      const std::uint8_t* const begin = Block(data, block);
      if (begin[0] != 0xFF || begin[1] != 0xEE || Azimuth(data, block) >= kTurn) return false;
    }
    return true;
  }

  static bool AreBlocksInPairs(const std::uint8_t* data) {
    for (int block = 0; block < kNumBlocks; block += 2) {
      if (Azimuth(data, block) != Azimuth(data, block + 1)) return false;
    }
    return Azimuth(data, 0) != Azimuth(data, 2);
  }

  // Angles of the user's own file stay. A sensor that was never calibrated has all bits set, or
  // none.
  void LearnState(const std::uint8_t* data) {
    constexpr std::uint8_t kDual = 0;
    has_two_returns_ = data[kReturnModeAt] == kDual;
    BeamTable beams(static_cast<std::size_t>(model_.num_lasers));
    bool is_blank = true;
    for (int laser = 0; laser < model_.num_lasers; ++laser) {
      Beam& beam = beams[laser];
      if (model_.num_lasers == 16) {
        const auto angle = static_cast<double>(ReadBig(data + kAngles16At + 3 * laser, 3));
        beam.elevation_rad = 1e-4 * angle * (laser < 8 ? -1 : 1) * kRadPerDeg;
      } else {
        beam.elevation_rad = Angle(data + kAnglesAt + 3 * laser);
        beam.azimuth_rad = Angle(data + kAnglesAt + 3 * (kNumChannels + laser));
      }
      if (std::abs(beam.elevation_rad) > M_PI / 2 || std::abs(beam.azimuth_rad) > M_PI) return;
      is_blank = is_blank && beam.elevation_rad == 0.0;
    }
    if (is_blank || has_own_angles_) return;
    NumberRings(&beams);
    CompleteBeams(&beams);
    model_.beams = std::move(beams);
    has_own_angles_ = true;
  }

  static double Angle(const std::uint8_t* bytes) {
    const auto angle = static_cast<double>(ReadBig(bytes + 1, 2));
    return 0.01 * (bytes[0] == 0 ? angle : -angle) * kRadPerDeg;
  }

  void CompleteBeams(BeamTable* beams) const {
    TakeElevations(unit_, beams);
    for (Beam& beam : *beams) beam.ahead_of_axis_m = model_.lens_m;
  }

  // How far the head turns from this block to the next, centidegrees; a sensor that looks at a part
  // of the turn only may jump there.
  int Advance(const std::uint8_t* data, int block, int num_copies) const {
    constexpr int kMaxAdvance = 100;
    const int from = block + num_copies < kNumBlocks ? block : block - num_copies;
    const int turned = (Azimuth(data, from + num_copies) - Azimuth(data, from) + kTurn) % kTurn;
    return turned <= kMaxAdvance ? turned : 0;
  }

  void AppendGroup(const std::uint8_t* data,
                   int block,
                   int num_copies,
                   std::vector<PacketReturn>* returns) const {
    const int num_firings = model_.num_lasers == kNumChannels || has_two_returns_
                                ? 1
                                : kNumChannels / model_.num_lasers;
    const double block_us = num_firings * model_.firing_us;
    const int advance = Advance(data, block, num_copies);
    for (int firing = 0; firing < num_firings; ++firing) {
      for (int laser = 0; laser < model_.num_lasers; ++laser) {
        const double in_block_us = firing * model_.firing_us + model_.laser_us(laser);
        const double head = Azimuth(data, block) + advance * in_block_us / block_us;
        const BeamEchoes echoes = EchoesOf(data, block, num_copies, firing, laser);
        for (int i = 0; i < echoes.size(); ++i) {
          returns->push_back(MeasuredBy(model_.beams[laser],
                                        head * 0.01 * kRadPerDeg,
                                        model_.unit_m * echoes[i].distance,
                                        echoes[i].intensity,
                                        ZeroAzimuth::kAlongX));
          returns->back().after_packet_us = block / num_copies * block_us + in_block_us;
          returns->back().number = i + 1;
          returns->back().of_how_many = echoes.size();
        }
      }
    }
  }

  BeamEchoes EchoesOf(
      const std::uint8_t* data, int block, int num_copies, int firing, int laser) const {
    BeamEchoes echoes;
    const auto add = [&](int at_block, int channel) {
      const std::uint8_t* const echo = Block(data, at_block) + 4 + 3 * channel;
      echoes.Add({static_cast<int>(ReadBig(echo, 2)), echo[2]});
    };
    for (int copy = 0; copy < num_copies; ++copy) {
      add(block + copy, firing * model_.num_lasers + laser);
    }
    if (model_.num_lasers < kNumChannels && has_two_returns_) add(block, model_.num_lasers + laser);
    return echoes;
  }

  Model model_;
  LidarUnit unit_;
  bool has_own_angles_;
  bool has_two_returns_ = false;
};

PacketDecoder MakeDecoder(Model model, const LidarUnit& unit) {
  return [decoder = Decoder(std::move(model), unit)](PacketBytes bytes) mutable {
    return decoder.Decode(bytes);
  };
}

double Laser16Us(int laser) { return 2.8 * laser; }
double Laser32Us(int laser) {
  return 1.44 * (2 * (laser % 16) + laser / 16 + (laser % 16 == 15 ? 1 : 0));
}
double LaserHeliosUs(int laser) { return std::max(0.0, (1.8965 - 0.014 * laser) * laser - 0.6543); }
double LaserBpearlUs(int laser) {
  return 1.28 * (2 * (laser % 16) + laser / 16 + 5.2 * (laser / 8 % 2));
}

const std::vector<std::uint8_t> kLongMark = {0x55, 0xAA, 0x05, 0x0A, 0x5A, 0xA5, 0x50, 0xA0};

}  // namespace

PacketDecoder MakeRobosense16(const LidarUnit& unit) {
  const BeamTable beams = BeamsAt({-15, -13, -11, -9, -7, -5, -3, -1, 15, 13, 11, 9, 7, 5, 3, 1});
  return MakeDecoder({kLongMark, 16, 0.005, false, 55.54, &Laser16Us, 0.03825, beams}, unit);
}

PacketDecoder MakeRobosense32(const LidarUnit& unit) {
  return MakeDecoder({kLongMark, 32, 0.005, false, 55.52, &Laser32Us, 0.03997, {}}, unit);
}

PacketDecoder MakeRobosenseHelios(const LidarUnit& unit) {
  const std::vector<std::uint8_t> mark = {0x55, 0xAA, 0x05, 0x5A};
  return MakeDecoder({mark, 32, 0.0025, true, 55.56, &LaserHeliosUs, 0.03498, {}}, unit);
}

PacketDecoder MakeRobosenseBpearl(const LidarUnit& unit) {
  return MakeDecoder({kLongMark, 32, 0.005, false, 55.56, &LaserBpearlUs, 0.01473, {}}, unit);
}

}  // namespace voqcal
