#include "core/lidar_packets/velodyne.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "core/lidar_packets/beam_table.hpp"
#include "core/lidar_packets/packet_fields.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr int kNumBlocks = 12;
constexpr int kLasersOfBlock = 32;
constexpr std::size_t kBlockBytes = 100;
constexpr std::size_t kPacketBytes = 1206;
constexpr int kTurn = 36000;  // centidegrees
constexpr std::uint8_t kStrongest = 0x37;
constexpr std::uint8_t kLast = 0x38;
constexpr std::uint8_t kDual = 0x39;

// What tells one model from another.
struct Model {
  std::vector<std::uint8_t> products;  // last byte of its packets, one of these; none: it has none
  int num_lasers;
  double unit_m;                  // of distance
  double firing_us;               // from a firing of all lasers to the next
  double (*laser_us)(int laser);  // after the firing's begin
  double (*turn_us)(int laser);   // for how long the head is taken to have turned then
  BeamTable beams;
};

// Little-endian fields of a packet of the right size.
class View {
 public:
  explicit View(PacketBytes bytes) : data_(bytes.data) {}

  int Flag(int block) const { return Read16(Block(block)); }
  int Azimuth(int block) const { return Read16(Block(block) + 2); }  // centidegrees
  RawEcho EchoOf(int block, int place) const {
    const std::uint8_t* const echo = Block(block) + 4 + 3 * place;
    return {Read16(echo), echo[2]};
  }
  std::uint32_t TimeUs() const { return Read32(data_ + 1200); }
  std::uint8_t Mode() const { return data_[1204]; }
  std::uint8_t Product() const { return data_[1205]; }

 private:
  const std::uint8_t* Block(int block) const { return data_ + block * kBlockBytes; }

  const std::uint8_t* data_;
};

class Decoder {
 public:
  explicit Decoder(Model model) : model_(std::move(model)) {}

  Expected<LidarPacket, PacketFault> Decode(PacketBytes bytes) {
    if (bytes.size != kPacketBytes) return PacketFault::kWrongSize;
    const View view(bytes);
    if (!IsOurs(view)) return PacketFault::kAlien;
    const bool is_dual = HasFactoryBytes() && view.Mode() == kDual;
    if (HasFactoryBytes() && !is_dual && view.Mode() != kStrongest && view.Mode() != kLast) {
      return PacketFault::kUnknownMode;
    }
    LidarPacket packet;
    packet.sensor_us = view.TimeUs();
    const int num_copies = is_dual ? 2 : 1;
    // A group: the blocks that one azimuth stands for, all returns of it.
    const int group = BlocksOfFiring() * num_copies;
    const int num_groups = kNumBlocks / group;
    packet.period_us = num_groups * FiringsOfBlock() * model_.firing_us;
    for (int i = 0; i < num_groups; ++i) {
      AppendGroup(view, i, group, num_copies, &packet.returns);
    }
    last_azimuth_ = view.Azimuth((num_groups - 1) * group);
    return packet;
  }

 private:
  bool HasFactoryBytes() const { return !model_.products.empty(); }
  bool IsProduct(std::uint8_t product) const {
    const auto& known = model_.products;
    return known.empty() || std::find(known.begin(), known.end(), product) != known.end();
  }
  int BlocksOfFiring() const { return std::max(1, model_.num_lasers / kLasersOfBlock); }
  int FiringsOfBlock() const { return std::max(1, kLasersOfBlock / model_.num_lasers); }

  // The banks of 32 lasers in their order: 0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF.
  bool IsOurs(const View& view) const {
    const int num_banks = BlocksOfFiring();
    const bool is_dual = HasFactoryBytes() && view.Mode() == kDual;
    for (int block = 0; block < kNumBlocks; ++block) {
      const int bank = (is_dual ? block / 2 : block) % num_banks;
      const bool is_padding = is_dual && num_banks == 4 && block >= 8;
      if (is_padding) break;
      if (view.Flag(block) != 0xEEFF - 0x1100 * bank || view.Azimuth(block) >= kTurn) return false;
    }
    return IsProduct(view.Product()) && view.TimeUs() < kVelodyneClockUs;
  }

  // How far the head turns during a group, centidegrees. The last of a packet takes the one before
  // as its measure, and so does one before a jump, of a sensor that looks at a part of the turn;
  // the only one takes the packet before.
  int Advance(const View& view, int i, int group) const {
    constexpr int kMaxAdvance = 200;  // 20 turns a second
    const int num_groups = kNumBlocks / group;
    const auto turned = [&view, group](int from) {
      return (view.Azimuth((from + 1) * group) - view.Azimuth(from * group) + kTurn) % kTurn;
    };
    const int since_last = (view.Azimuth(0) - last_azimuth_ + kTurn) % kTurn;
    if (i + 1 < num_groups && turned(i) <= kMaxAdvance) return turned(i);
    if (i > 0 && turned(i - 1) <= kMaxAdvance) return turned(i - 1);
    return last_azimuth_ >= 0 && since_last <= kMaxAdvance ? since_last : 0;
  }

  void AppendGroup(const View& view,
                   int i,
                   int group,
                   int num_copies,
                   std::vector<PacketReturn>* returns) const {
    const int first_block = i * group;
    const int advance = Advance(view, i, group);
    const double group_us = FiringsOfBlock() * model_.firing_us;
    for (int firing = 0; firing < FiringsOfBlock(); ++firing) {
      for (int laser = 0; laser < model_.num_lasers; ++laser) {
        const int block = first_block + laser / kLasersOfBlock * num_copies;
        const int place = (firing * model_.num_lasers + laser) % kLasersOfBlock;
        BeamEchoes echoes;
        for (int copy = 0; copy < num_copies; ++copy) echoes.Add(view.EchoOf(block + copy, place));
        const double in_group_us = firing * model_.firing_us + model_.laser_us(laser);
        const double turned_us = firing * model_.firing_us + model_.turn_us(laser);
        const double head = view.Azimuth(first_block) + advance * turned_us / group_us;
        AppendEchoes(echoes, model_.beams[laser], head, i * group_us + in_group_us, returns);
      }
    }
  }

  void AppendEchoes(const BeamEchoes& echoes,
                    const Beam& beam,
                    double head,
                    double after_packet_us,
                    std::vector<PacketReturn>* returns) const {
    const double head_rad = std::fmod(head, kTurn) * 0.01 * kRadPerDeg;
    for (int i = 0; i < echoes.size(); ++i) {
      PacketReturn echo = MeasuredBy(beam,
                                     head_rad,
                                     model_.unit_m * echoes[i].distance,
                                     echoes[i].intensity,
                                     ZeroAzimuth::kAlongX);
      echo.azimuth_rad = head_rad;  // sweeps end for all lasers at once, as in ROS' driver
      echo.after_packet_us = after_packet_us;
      echo.number = i + 1;
      echo.of_how_many = echoes.size();
      returns->push_back(echo);
    }
  }

  Model model_;
  int last_azimuth_ = -1;
};

double Metres(const YAML::Node& laser, const char* key) {
  return laser[key] ? laser[key].as<double>() : 0.0;
}

BeamTable ReadCalibration(const std::string& text, int num_lasers) try {
  const YAML::Node lasers = YAML::Load(text)["lasers"];
  if (!lasers.IsSequence() || lasers.size() != static_cast<std::size_t>(num_lasers)) {
    throw std::invalid_argument("lasers must be a list of " + std::to_string(num_lasers) +
                                ", has " + std::to_string(lasers.IsSequence() ? lasers.size() : 0));
  }
  BeamTable beams(num_lasers);
  for (const YAML::Node& laser : lasers) {
    Beam& beam = beams.at(laser["laser_id"].as<std::size_t>());
    beam.elevation_rad = laser["vert_correction"].as<double>();
    beam.azimuth_rad = -laser["rot_correction"].as<double>();
    beam.range_m = Metres(laser, "dist_correction");
    beam.above_centre_m = Metres(laser, "vert_offset_correction");
    beam.beside_axis_m = Metres(laser, "horiz_offset_correction");
  }
  NumberRings(&beams);
  return beams;
} catch (const YAML::Exception& error) {
  throw std::invalid_argument(std::string("is not a calibration of Velodyne's as YAML: ") +
                              error.what());
} catch (const std::out_of_range&) {
  throw std::invalid_argument("laser_id must be 0 to " + std::to_string(num_lasers - 1));
}

PacketDecoder MakeDecoder(Model model, const LidarUnit& unit) {
  if (!unit.calibration.empty()) model.beams = ReadCalibration(unit.calibration, model.num_lasers);
  TakeElevations(unit, &model.beams);
  return [decoder = Decoder(std::move(model))](PacketBytes bytes) mutable {
    return decoder.Decode(bytes);
  };
}

// Of the lower half and the upper half in turn, both from below: -15 1 -13 3 ... degrees.
BeamTable TwoHalves(int num_lasers, double lowest_deg, double step_deg) {
  std::vector<double> elevations_deg;
  for (int laser = 0; laser < num_lasers; ++laser) {
    const int ring = laser % 2 == 0 ? laser / 2 : num_lasers / 2 + laser / 2;
    elevations_deg.push_back(lowest_deg + step_deg * ring);
  }
  return BeamsAt(elevations_deg);
}

double Vlp16LaserUs(int laser) { return 2.304 * laser; }
// Two lasers fire at once. ROS' drivers turn the head on between the two nevertheless, by 0.13
// degrees too far at 10 turns a second for the last; so do we, that extrinsics fit their clouds.
double Vlp32LaserUs(int laser) { return 2.304 * (laser / 2); }
double Vlp32TurnUs(int laser) { return 2.304 * laser; }
double Hdl32LaserUs(int laser) { return 1.152 * laser; }
// Eight at once, with a pause after the eighth group.
double Vls128LaserUs(int laser) { return 2.665 * (laser / 8 + laser / 64); }
double Hdl64LaserUs(int laser) { return 1.2 * (laser % kLasersOfBlock); }

// VLP-32C User Manual, table of elevations and azimuth offsets.
BeamTable Vlp32Beams() {
  return BeamsAt(
      {-25,    -1,     -1.667, -15.639, -11.31, 0,      -0.667, -8.843, -7.254, 0.333,  -0.333,
       -6.148, -5.333, 1.333,  0.667,   -4,     -4.667, 1.667,  1,      -3.667, -3.333, 3.333,
       2.333,  -2.667, -3,     7,       4.667,  -2.333, -2,     15,     10.333, -1.333},
      {1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
       1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4});
}

// VLS-128 User Manual, table of elevations and azimuth offsets.
BeamTable Vls128Beams() {
  const std::vector<double> elevations_deg = {
      -11.742, -1.99,   3.4,   -5.29,   -0.78, 4.61,  -4.08,   1.31,   -6.5,  -1.11,   4.28,  -4.41,
      0.1,     6.48,    -3.2,  2.19,    -3.86, 1.53,  -9.244,  -1.77,  2.74,  -5.95,   -0.56, 4.83,
      -2.98,   2.41,    -6.28, -0.89,   3.62,  -5.07, 0.32,    7.58,   -0.34, 5.18,    -3.64, 1.75,
      -25,     -2.43,   2.96,  -5.73,   0.54,  9.7,   -2.76,   2.63,   -7.65, -1.55,   3.84,  -4.85,
      3.18,    -5.51,   -0.12, 5.73,    -4.3,  1.09,  -16.042, -2.21,  4.06,  -4.63,   0.76,  15,
      -3.42,   1.97,    -6.85, -1.33,   -5.62, -0.23, 5.43,    -3.53,  0.98,  -19.582, -2.32, 3.07,
      -4.74,   0.65,    11.75, -2.65,   1.86,  -7.15, -1.44,   3.95,   -2.1,  3.29,    -5.4,  -0.01,
      4.5,     -4.19,   1.2,   -13.565, -1.22, 4.17,  -4.52,   0.87,   6.08,  -3.31,   2.08,  -6.65,
      1.42,    -10.346, -1.88, 3.51,    -6.06, -0.67, 4.72,    -3.97,  2.3,   -6.39,   -1,    4.39,
      -5.18,   0.21,    6.98,  -3.09,   4.98,  -3.75, 1.64,    -8.352, -2.54, 2.85,    -5.84, -0.45,
      8.43,    -2.87,   2.52,  -6.17,   -1.66, 3.73,  -4.96,   0.43};
  const double columns_deg[] = {6.354, 4.548, 2.732, 0.911, -0.911, -2.732, -4.548, -6.354};
  std::vector<double> azimuths_deg;
  for (int laser = 0; laser < 128; ++laser) azimuths_deg.push_back(columns_deg[laser % 8]);
  return BeamsAt(elevations_deg, azimuths_deg);
}

}  // namespace

PacketDecoder MakeVelodyneVlp16(const LidarUnit& unit) {
  return MakeDecoder(
      {{0x22}, 16, 0.002, 55.296, &Vlp16LaserUs, &Vlp16LaserUs, TwoHalves(16, -15, 2)}, unit);
}

PacketDecoder MakeVelodyneVlp16HiRes(const LidarUnit& unit) {
  return MakeDecoder(
      {{0x24}, 16, 0.002, 55.296, &Vlp16LaserUs, &Vlp16LaserUs, TwoHalves(16, -10, 4.0 / 3)}, unit);
}

PacketDecoder MakeVelodyneVlp32c(const LidarUnit& unit) {
  return MakeDecoder({{0x28}, 32, 0.004, 55.296, &Vlp32LaserUs, &Vlp32TurnUs, Vlp32Beams()}, unit);
}

// 0x63 is what the first manual says, 0xA1 what the Alpha Prime sends.
PacketDecoder MakeVelodyneVls128(const LidarUnit& unit) {
  return MakeDecoder(
      {{0x63, 0xA1}, 128, 0.004, 53.3, &Vls128LaserUs, &Vls128LaserUs, Vls128Beams()}, unit);
}

PacketDecoder MakeVelodyneHdl32e(const LidarUnit& unit) {
  return MakeDecoder(
      {{0x21}, 32, 0.002, 46.08, &Hdl32LaserUs, &Hdl32LaserUs, TwoHalves(32, -92.0 / 3, 4.0 / 3)},
      unit);
}

PacketDecoder MakeVelodyneHdl64e(const LidarUnit& unit) {
  return MakeDecoder({{}, 64, 0.002, 46.25, &Hdl64LaserUs, &Hdl64LaserUs, BeamTable(64)}, unit);
}

}  // namespace voqcal
