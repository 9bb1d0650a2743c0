// decode_packets: a lidar's datagrams, as import_ros finds them in recordings, to clouds. It is
// import_ros' own helper; people run decode_lidar.
//
// stdin:  'p' i64 utime (us), u32 length, bytes: one datagram; 'e': answer what came of all so far.
// stdout: kind, u32 length, bytes: 'c', a sweep as pointcloud2_t; 'e', of no bytes: that is all for
//         now. After the end of stdin come the last sweeps, then 't', what there was, for people.
// All numbers are little-endian.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/tool_main.hpp"
#include "core/lidar_packets/lidar_recognition.hpp"
#include "core/lidar_packets/packet_fields.hpp"
#include "core/lidar_packets/packet_stream.hpp"
#include "core/likelihood/lidar_bias.hpp"
#include "files/atomic_file.hpp"
#include "lidar_driver/calibrated_stream.hpp"
#include "lidar_driver/packet_source.hpp"
#include "messaging/convert_points.hpp"
#include "messaging/encode.hpp"
#include "result/lidar_bias_yaml.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

struct PacketArgs {
  std::filesystem::path rig;
  std::string model;
  std::filesystem::path calibration;
  std::filesystem::path metadata;
};

// As flags, rig file and recording say, in this order.
LidarSensorOptions SensorOptions(const PacketArgs& args, bool* is_model_known) {
  LidarSensorOptions options;
  if (!args.rig.empty()) {
    const Rig rig = LoadRig(args.rig, SensorChoice::kLidar);
    options = rig.lidar_sensor;
    *is_model_known = rig.lidar_driver.source == LidarDriverOptions::Source::kSensor;
  }
  if (!args.model.empty()) {
    options.packets.protocol = FindLidarProtocol(args.model);
    *is_model_known = true;
  }
  if (*is_model_known && !options.packets.protocol) {
    throw std::runtime_error("--lidar-model must be one of " + LidarProtocolNames() + ", is \"" +
                             args.model + '"');
  }
  if (!args.calibration.empty()) options.calibration = args.calibration;
  if (options.calibration.empty()) options.calibration = args.metadata;
  return options;
}

// Datagrams in, sweeps out; what sent them is recognised if nobody said it.
class PacketDecoding {
 public:
  PacketDecoding(LidarSensorOptions options, bool is_model_known) : options_(std::move(options)) {
    if (is_model_known) Start();
  }

  std::vector<TimedSweep> Add(HostPacket packet) {
    if (stream_) return AddTo(packet);
    Recognise(packet);
    held_.push_back(std::move(packet));
    std::vector<TimedSweep> ended;
    if (!stream_) return ended;
    for (const HostPacket& held : std::exchange(held_, {})) {
      for (TimedSweep& sweep : AddTo(held)) ended.push_back(std::move(sweep));
    }
    return ended;
  }

  /// @throws std::runtime_error if no datagram was understood, saying why.
  std::vector<TimedSweep> Finish() {
    if (!stream_) throw std::runtime_error(UnknownText());
    auto ended = stream_->Finish();
    if (stream_->Counts().count("packets") == 0) {
      const std::string wrong = stream_->WrongLidar();
      throw std::runtime_error(wrong.empty() ? "no packet with points" : wrong);
    }
    return ended;
  }

  bool HasRings() const { return options_.packets.protocol->has_rings; }

  /// "packets of a Velodyne VLP-16: 1200 packets, 3 packets lost".
  std::string Text() const {
    std::string text = "packets of a " + options_.packets.protocol->title + ':';
    for (const auto& [what, count] : stream_->Counts()) {
      text += (text.back() == ':' ? " " : ", ") + std::to_string(count) + ' ' + what;
    }
    return text;
  }

 private:
  static constexpr std::size_t kMaxHeld = 5000;  // a second or more of any lidar

  void Start() { stream_.emplace(CalibratedStream(options_.packets, options_.calibration)); }

  std::vector<TimedSweep> AddTo(const HostPacket& packet) {
    return stream_->Add({packet.bytes.data(), packet.bytes.size()}, packet.utime);
  }

  void Recognise(const HostPacket& packet) {
    if (!calibration_) {
      calibration_ = options_.calibration.empty() ? "" : ReadWholeFile(options_.calibration);
    }
    const auto senders = LidarsThatSend({packet.bytes.data(), packet.bytes.size()}, *calibration_);
    if (senders.size() > 1) {
      std::string names;
      for (const LidarProtocol* sender : senders) {
        names += (names.empty() ? "" : ", ") + sender->name;
      }
      throw std::runtime_error(
          "several lidars send such packets: --lidar-model must say which of " + names +
          ", or lidar_driver.source of the rig file");
    }
    if (senders.size() == 1) {
      options_.packets.protocol = senders.front();
      Start();
    } else if (held_.size() >= kMaxHeld) {
      throw std::runtime_error(UnknownText());
    }
  }

  std::string UnknownText() const {
    if (held_.empty()) return "there is no packet";
    return "whose packets these are is not recognised (" + std::to_string(held_.size()) +
           ", the last of " + std::to_string(held_.back().bytes.size()) +
           " bytes): --lidar-model names the lidar, --lidar-calibration its file if it needs one "
           "(Ouster: the metadata)";
  }

  LidarSensorOptions options_;
  std::optional<LidarPacketStream> stream_;
  std::optional<std::string> calibration_;
  std::vector<HostPacket> held_;
};

// False at the end of stdin.
bool Read(std::uint8_t* bytes, std::size_t num_bytes) {
  const std::size_t num_read = std::fread(bytes, 1, num_bytes, stdin);
  if (num_read != 0 && num_read != num_bytes) throw std::runtime_error("stdin: ends in a packet");
  return num_read == num_bytes;
}

HostPacket ReadPacket() {
  std::uint8_t head[12];
  if (!Read(head, sizeof(head))) throw std::runtime_error("stdin: ends in a packet");
  HostPacket packet;
  packet.utime = static_cast<std::int64_t>(ReadLittle(head, 8));
  packet.bytes.resize(Read32(head + 8));
  if (!packet.bytes.empty() && !Read(packet.bytes.data(), packet.bytes.size())) {
    throw std::runtime_error("stdin: ends in a packet");
  }
  return packet;
}

void Write(char kind, const void* bytes, std::size_t num_bytes) {
  const std::uint8_t head[] = {static_cast<std::uint8_t>(kind),
                               static_cast<std::uint8_t>(num_bytes),
                               static_cast<std::uint8_t>(num_bytes >> 8),
                               static_cast<std::uint8_t>(num_bytes >> 16),
                               static_cast<std::uint8_t>(num_bytes >> 24)};
  std::fwrite(head, 1, sizeof(head), stdout);
  if (num_bytes > 0) std::fwrite(bytes, 1, num_bytes, stdout);
}

void DecodePackets(const PacketArgs& args) {
  bool is_model_known = false;
  const LidarSensorOptions options = SensorOptions(args, &is_model_known);
  const LidarBias bias = options.bias_from.empty() ? LidarBias() : ReadLidarBias(options.bias_from);
  PacketDecoding decoding(options, is_model_known);
  std::int32_t seq = 0;
  const auto write = [&](const std::vector<TimedSweep>& sweeps) {
    for (const TimedSweep& sweep : sweeps) {
      const PointCloud cloud = bias.Corrected(sweep.Cloud(decoding.HasRings()));
      const auto bytes = EncodeMessage(ToMessage(cloud, sweep.utime, seq++));
      Write('c', bytes.data(), bytes.size());
    }
  };
  for (std::uint8_t kind = 0; Read(&kind, 1);) {
    if (kind == 'p') {
      write(decoding.Add(ReadPacket()));
    } else {
      Write('e', nullptr, 0);
      std::fflush(stdout);
    }
  }
  write(decoding.Finish());
  const std::string text = decoding.Text();
  Write('t', text.data(), text.size());
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app("Decodes lidar packets for import_ros: stdin to stdout.", "decode_packets");
  voqcal::PacketArgs args;
  app.add_option("--rig", args.rig, "Whose lidar_driver.sensor says how to decode");
  app.add_option("--model", args.model, "The lidar; else the rig's, else it is recognised");
  app.add_option("--calibration", args.calibration, "The vendor's file on this very unit");
  app.add_option("--metadata", args.metadata, "The same from the recording, if no other is named");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::DecodePackets(args); });
}
