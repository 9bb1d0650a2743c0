#include "core/lidar_packets/hesai.hpp"

#include <cmath>
#include <ctime>
#include <utility>

#include "core/lidar_packets/beam_table.hpp"
#include "core/lidar_packets/hesai_angles.hpp"
#include "core/lidar_packets/packet_fields.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr int kTurn = 36000;  // centidegrees

// Where the fields of the tail are, from its begin.
struct Tail {
  std::size_t mode;
  std::size_t date;  // year, month, day, hour, minute, second: a byte each
  int first_year;
  std::size_t time;    // microseconds of the second, 4 bytes
  std::size_t number;  // of the packet, 4 bytes, if it is so long
};

constexpr Tail kPandarTail{14, 16, 2000, 10, 22};
constexpr Tail kQt64Tail{16, 18, 1900, 12, 24};
constexpr Tail kXtTail{10, 13, 1900, 19, 24};
constexpr Tail kQt128Tail{12, 15, 1900, 21, 26};  // the OT128's too

// When lasers fire, microseconds from the packet's time.
struct Timing {
  double group_us;  // from firing to firing of all lasers
  double first_us;  // of the first group, or of the last if `is_from_last`
  bool is_from_last;
  double (*laser_us)(int channel);
};

// What tells one model's packets from another's.
struct Format {
  std::size_t header_bytes;
  std::size_t flag_bytes;  // before each block's azimuth
  int num_blocks;
  int num_lasers;
  std::size_t echo_bytes;
  std::size_t before_tail_bytes;  // checksum and state, between blocks and tail
  Tail tail;
  int min_distance;  // smaller ones are codes for why there is no echo
  Timing timing;

  std::size_t BlockBytes() const { return flag_bytes + 2 + num_lasers * echo_bytes; }
  std::size_t TailAt() const {
    return header_bytes + num_blocks * BlockBytes() + before_tail_bytes;
  }
  std::size_t NumberAt() const { return TailAt() + tail.number; }
};

// 0: not known.
int NumReturns(std::uint8_t mode) {
  switch (mode) {
    case 0x33:  // first
    case 0x34:  // second
    case 0x37:  // strongest
    case 0x38:  // last
      return 1;
    case 0x39:  // last and strongest
    case 0x3A:  // first and second
    case 0x3B:  // first and last
    case 0x3C:  // first and strongest
    case 0x3E:  // strongest and second strongest
      return 2;
    case 0x3D:  // first, last and strongest
      return 3;
    default:
      return 0;
  }
}

std::int64_t UtcUs(const std::uint8_t* date, int first_year, std::uint32_t time_us) {
  std::tm parts{};
  parts.tm_year = date[0] + first_year - 1900;
  parts.tm_mon = date[1] - 1;
  parts.tm_mday = date[2];
  parts.tm_hour = date[3];
  parts.tm_min = date[4];
  parts.tm_sec = date[5];
  return std::int64_t{timegm(&parts)} * 1000000 + time_us;
}

class Decoder {
 public:
  Decoder(Format format, BeamTable beams) : format_(format), beams_(std::move(beams)) {}

  Expected<LidarPacket, PacketFault> Decode(PacketBytes bytes) const {
    constexpr std::size_t kMaxExtraBytes = 80;  // number, signature, motion
    if (bytes.size < format_.NumberAt() || bytes.size > format_.NumberAt() + kMaxExtraBytes) {
      return PacketFault::kWrongSize;
    }
    if (!IsOurs(bytes.data)) return PacketFault::kAlien;
    const std::uint8_t* const tail = bytes.data + format_.TailAt();
    const int num_returns = NumReturns(tail[format_.tail.mode]);
    if (num_returns == 0) return PacketFault::kUnknownMode;
    LidarPacket packet;
    packet.sensor_us =
        UtcUs(tail + format_.tail.date, format_.tail.first_year, Read32(tail + format_.tail.time));
    if (bytes.size >= format_.NumberAt() + 4) packet.number = Read32(tail + format_.tail.number);
    for (int group = 0; group < format_.num_blocks / num_returns; ++group) {
      AppendGroup(bytes.data, group, num_returns, &packet.returns);
    }
    return packet;
  }

 private:
  const std::uint8_t* Block(const std::uint8_t* data, int block) const {
    return data + format_.header_bytes + block * format_.BlockBytes();
  }

  bool IsOurs(const std::uint8_t* data) const {
    constexpr std::size_t kLongHeader = 12;
    if (format_.header_bytes > 0) {
      const std::size_t counts_at = format_.header_bytes == kLongHeader ? 6 : 2;
      const bool is_same = data[0] == 0xEE && data[1] == 0xFF &&
                           data[counts_at] == format_.num_lasers &&
                           data[counts_at + 1] == format_.num_blocks;
      if (!is_same) return false;
    }
    for (int block = 0; block < format_.num_blocks; ++block) {
      const std::uint8_t* const begin = Block(data, block);
      if (format_.flag_bytes > 0 && (begin[0] != 0xFF || begin[1] != 0xEE)) return false;
      if (Read16(begin + format_.flag_bytes) >= kTurn) return false;
    }
    return true;
  }

  double UnitM(const std::uint8_t* data) const {
    constexpr double kUnitM = 0.004;  // of the one without header
    return format_.header_bytes == 0 ? kUnitM : 1e-3 * data[format_.header_bytes == 12 ? 9 : 5];
  }

  void AppendGroup(const std::uint8_t* data,
                   int group,
                   int num_returns,
                   std::vector<PacketReturn>* returns) const {
    const int num_groups = format_.num_blocks / num_returns;
    const Timing& timing = format_.timing;
    const int steps = timing.is_from_last ? group - (num_groups - 1) : group;
    const double group_us = timing.first_us + steps * timing.group_us;
    const std::uint8_t* const block = Block(data, group * num_returns);
    const double head_rad = Read16(block + format_.flag_bytes) * 0.01 * kRadPerDeg;
    const double unit_m = UnitM(data);
    for (int channel = 0; channel < format_.num_lasers; ++channel) {
      const BeamEchoes echoes = EchoesOf(block, channel, num_returns);
      for (int i = 0; i < echoes.size(); ++i) {
        returns->push_back(MeasuredBy(beams_[channel],
                                      head_rad,
                                      unit_m * echoes[i].distance,
                                      echoes[i].intensity,
                                      ZeroAzimuth::kAlongY));
        returns->back().after_packet_us = group_us + timing.laser_us(channel);
        returns->back().number = i + 1;
        returns->back().of_how_many = echoes.size();
      }
    }
  }

  // Of two returns at one distance Hesai's own tools keep the later block's.
  BeamEchoes EchoesOf(const std::uint8_t* block, int channel, int num_returns) const {
    BeamEchoes echoes;
    for (int copy = num_returns - 1; copy >= 0; --copy) {
      const std::uint8_t* const echo = block + copy * format_.BlockBytes() + format_.flag_bytes +
                                       2 + channel * format_.echo_bytes;
      const int distance = Read16(echo);
      if (distance >= format_.min_distance) echoes.Add({distance, echo[2]});
    }
    return echoes;
  }

  Format format_;
  BeamTable beams_;
};

PacketDecoder MakeDecoder(const Format& format, BeamTable beams, const LidarUnit& unit) {
  if (!unit.calibration.empty()) beams = ReadBeamCsv(unit.calibration, beams.size());
  TakeElevations(unit, &beams);
  return [decoder = Decoder(format, std::move(beams))](PacketBytes bytes) {
    return decoder.Decode(bytes);
  };
}

// Times at which the lasers fire, before the end of their block, rounded.
double Pandar40LaserUs(int channel) {
  constexpr double kUs[] = {-42.22, -28.47, -16.04, -3.62,  -45.49, -31.74, -47.46, -54.67,
                            -20.62, -33.71, -40.91, -8.19,  -20.62, -27.16, -50.73, -8.19,
                            -14.74, -36.98, -45.49, -52.70, -23.89, -31.74, -38.95, -11.47,
                            -18.65, -25.19, -48.76, -6.23,  -12.77, -35.01, -21.92, -9.50,
                            -43.52, -29.77, -17.35, -4.92,  -42.22, -28.47, -16.04, -3.62};
  return kUs[channel];
}

double Pandar64LaserUs(int channel) {
  constexpr double kUs[] = {
      -23.18, -21.88, -20.57, -19.27, -17.96, -16.66, -11.44, -46.80, -7.53,  -36.96, -50.73,
      -54.67, -40.89, -44.83, -31.05, -34.99, -48.76, -52.70, -38.92, -42.86, -29.08, -33.02,
      -46.80, -25.15, -36.96, -50.73, -27.12, -40.89, -44.83, -31.05, -34.99, -48.76, -25.15,
      -38.92, -42.86, -29.08, -33.02, -52.70, -6.23,  -54.67, -15.36, -27.12, -10.14, -23.18,
      -4.92,  -21.88, -14.05, -17.96, -8.84,  -19.27, -3.62,  -20.57, -12.75, -16.66, -7.53,
      -11.44, -6.23,  -15.36, -10.14, -4.92,  -3.62,  -14.05, -8.84,  -12.75};
  return kUs[channel];
}

// Every 2.057 us, with pauses after 8 and after 16; within 0.03 us of the manual's table.
double Qt64LaserUs(int channel) {
  return 12.31 + 2.057 * channel + 0.39 * (channel / 8) + 0.6 * (channel / 16);
}

double Xt16LaserUs(int channel) { return 0.368 + 3.024 * channel; }
double Xt32LaserUs(int channel) { return 0.368 + 1.512 * channel; }
double Xt32mLaserUs(int channel) { return 0.368 + 2.888 * (channel % 16); }

// Lasers fire in an order that changes from block to block; the middle of it, half of it off at
// most.
double Qt128LaserUs(int) { return 50.0; }
double Ot128LaserUs(int) { return 25.0; }

}  // namespace

PacketDecoder MakeHesai40p(const LidarUnit& unit) {
  const Format format{0, 2, 10, 40, 3, 0, kPandarTail, 1, {55.56, -28.58, true, &Pandar40LaserUs}};
  return MakeDecoder(format, Hesai40pBeams(), unit);
}

PacketDecoder MakeHesai64(const LidarUnit& unit) {
  const Format format{8, 0, 6, 64, 3, 0, kPandarTail, 1, {55.56, -42.58, true, &Pandar64LaserUs}};
  return MakeDecoder(format, Hesai64Beams(), unit);
}

PacketDecoder MakeHesaiQt64(const LidarUnit& unit) {
  const Format format{12, 0, 4, 64, 4, 0, kQt64Tail, 1, {166.67, 25.71, false, &Qt64LaserUs}};
  return MakeDecoder(format, HesaiQt64Beams(), unit);
}

PacketDecoder MakeHesaiQt128(const LidarUnit& unit) {
  const Format format{12, 0, 2, 128, 4, 21, kQt128Tail, 1, {111.11, 9.0, true, &Qt128LaserUs}};
  return MakeDecoder(format, HesaiQt128Beams(), unit);
}

PacketDecoder MakeHesaiXt16(const LidarUnit& unit) {
  const Format format{12, 0, 8, 16, 4, 0, kXtTail, 1, {50.0, 5.632, true, &Xt16LaserUs}};
  return MakeDecoder(format, HesaiXt16Beams(), unit);
}

PacketDecoder MakeHesaiXt32(const LidarUnit& unit) {
  const Format format{12, 0, 8, 32, 4, 0, kXtTail, 1, {50.0, 5.632, true, &Xt32LaserUs}};
  return MakeDecoder(format, HesaiXt32Beams(), unit);
}

PacketDecoder MakeHesaiXt32m(const LidarUnit& unit) {
  const Format format{12, 0, 6, 32, 4, 0, kXtTail, 1, {50.0, 5.632, true, &Xt32mLaserUs}};
  return MakeDecoder(format, HesaiXt32mBeams(), unit);
}

PacketDecoder MakeHesaiOt128(const LidarUnit& unit) {
  const Format format{12, 0, 2, 128, 3, 21, kQt128Tail, 4, {55.556, 43.346, true, &Ot128LaserUs}};
  return MakeDecoder(format, HesaiOt128Beams(), unit);
}

}  // namespace voqcal
