#include "core/lidar_packets/lidar_protocols.hpp"

#include <algorithm>
#include <cmath>

#include "core/lidar_packets/hesai.hpp"
#include "core/lidar_packets/livox.hpp"
#include "core/lidar_packets/ouster.hpp"
#include "core/lidar_packets/robosense.hpp"
#include "core/lidar_packets/spectrum_scan.hpp"
#include "core/lidar_packets/velodyne.hpp"

namespace voqcal {
namespace {

// A spinning lidar; its beams may point up to `overlap_rad` away from where its head does.
LidarProtocol Spinning(std::string name,
                       std::string short_name,
                       std::string title,
                       int num_rings,
                       std::vector<std::size_t> packet_bytes,
                       std::int64_t clock_us,
                       double overlap_rad,
                       std::string calibration,
                       PacketDecoder (*make_decoder)(const LidarUnit&)) {
  LidarProtocol protocol;
  protocol.name = std::move(name);
  protocol.short_name = std::move(short_name);
  protocol.title = std::move(title);
  protocol.num_rings = num_rings;
  protocol.port = 2368;
  protocol.packet_bytes = std::move(packet_bytes);
  protocol.clock_us = clock_us;
  protocol.has_utc = true;
  protocol.overlap_rad = overlap_rad;
  protocol.calibration = std::move(calibration);
  protocol.make_decoder = make_decoder;
  return protocol;
}

LidarProtocol Velodyne(std::string name,
                       std::string short_name,
                       std::string title,
                       int num_rings,
                       PacketDecoder (*make_decoder)(const LidarUnit&)) {
  return Spinning(std::move(name),
                  std::move(short_name),
                  std::move(title),
                  num_rings,
                  {1206},
                  kVelodyneClockUs,
                  0.0,
                  "velodyne_pointcloud's YAML",
                  make_decoder);
}

LidarProtocol Hdl64e() {
  LidarProtocol protocol =
      Velodyne("velodyne_hdl64e", "", "Velodyne HDL-64E", 64, &MakeVelodyneHdl64e);
  protocol.needs_calibration = true;
  return protocol;
}

LidarProtocol Hesai(std::string name,
                    std::string title,
                    int num_rings,
                    std::vector<std::size_t> packet_bytes,
                    PacketDecoder (*make_decoder)(const LidarUnit&)) {
  constexpr double kOverlapRad =
      25.0 * M_PI / 180.0;  // QT128: beams up to 10.1 degrees to either side
  return Spinning(std::move(name),
                  "",
                  std::move(title),
                  num_rings,
                  std::move(packet_bytes),
                  kEndlessClockUs,
                  kOverlapRad,
                  "Hesai's angle correction file, CSV",
                  make_decoder);
}

LidarProtocol Ouster() {
  LidarProtocol protocol;
  protocol.name = "ouster";
  protocol.title = "Ouster OS-0, OS-1, OS-2";
  protocol.port = 7502;
  protocol.clock_us = kEndlessClockUs;
  protocol.has_utc = true;
  protocol.sweep_end = SweepEnd::kAtFrame;
  protocol.calibration = "the sensor's metadata, JSON";
  protocol.needs_calibration = true;
  protocol.make_decoder = &MakeOuster;
  return protocol;
}

LidarProtocol Robosense(std::string name,
                        std::string title,
                        int num_rings,
                        PacketDecoder (*make_decoder)(const LidarUnit&)) {
  constexpr double kOverlapRad = 25.0 * M_PI / 180.0;
  LidarProtocol protocol = Spinning(std::move(name),
                                    "",
                                    std::move(title),
                                    num_rings,
                                    {1248},
                                    kEndlessClockUs,
                                    kOverlapRad,
                                    "RoboSense's angle file, CSV",
                                    make_decoder);
  protocol.port = 6699;
  return protocol;
}

LidarProtocol Livox(std::string name,
                    std::string title,
                    int port,
                    std::vector<std::size_t> packet_bytes,
                    PacketDecoder (*make_decoder)(const LidarUnit&)) {
  LidarProtocol protocol;
  protocol.name = std::move(name);
  protocol.title = std::move(title);
  protocol.has_rings = false;
  protocol.port = port;
  protocol.packet_bytes = std::move(packet_bytes);
  protocol.clock_us = kEndlessClockUs;
  protocol.has_utc = true;
  protocol.sweep_end = SweepEnd::kAtTime;
  protocol.make_decoder = make_decoder;
  return protocol;
}

LidarProtocol SpectrumScan() {
  LidarProtocol protocol;
  protocol.name = "baraja_spectrum_scan";
  protocol.short_name = "spectrum_scan";
  protocol.title = "Baraja Spectrum-Scan";
  protocol.has_rings = false;
  protocol.port = 5044;
  protocol.packet_bytes = {1448};
  protocol.clock_us = std::int64_t{1} << 32;
  protocol.sweep_end = SweepEnd::kAtJump;
  protocol.make_decoder = &MakeSpectrumScan;
  return protocol;
}

}  // namespace

const std::vector<LidarProtocol>& LidarProtocols() {
  static const std::vector<LidarProtocol> protocols = {
      Velodyne("velodyne_vlp16", "vlp16", "Velodyne VLP-16", 16, &MakeVelodyneVlp16),
      Velodyne("velodyne_vlp16_hires", "", "Velodyne Puck Hi-Res", 16, &MakeVelodyneVlp16HiRes),
      Velodyne("velodyne_vlp32", "velodyne_vlp32c", "Velodyne VLP-32C", 32, &MakeVelodyneVlp32c),
      Velodyne("velodyne_vls128", "", "Velodyne VLS-128", 128, &MakeVelodyneVls128),
      Velodyne("velodyne_hdl32", "velodyne_hdl32e", "Velodyne HDL-32E", 32, &MakeVelodyneHdl32e),
      Hdl64e(),
      Hesai("hesai_40p", "Hesai Pandar40P", 40, {1262, 1266}, &MakeHesai40p),
      Hesai("hesai_64", "Hesai Pandar64", 64, {1194, 1198}, &MakeHesai64),
      Hesai("hesai_qt64", "Hesai PandarQT", 64, {1072}, &MakeHesaiQt64),
      Hesai("hesai_qt128", "Hesai QT128", 128, {1127}, &MakeHesaiQt128),
      Hesai("hesai_xt16", "Hesai PandarXT-16", 16, {568}, &MakeHesaiXt16),
      Hesai("hesai_xt32", "Hesai PandarXT-32", 32, {1080}, &MakeHesaiXt32),
      Hesai("hesai_xt32m", "Hesai PandarXT-32M", 32, {820}, &MakeHesaiXt32m),
      Hesai("hesai_ot128", "Hesai OT128", 128, {861, 893}, &MakeHesaiOt128),
      Ouster(),
      Robosense("robosense_16", "RoboSense RS-LiDAR-16", 16, &MakeRobosense16),
      Robosense("robosense_32", "RoboSense RS-LiDAR-32", 32, &MakeRobosense32),
      Robosense("robosense_helios", "RoboSense Helios", 32, &MakeRobosenseHelios),
      Robosense("robosense_bpearl", "RoboSense Bpearl", 32, &MakeRobosenseBpearl),
      Livox("livox_mid360", "Livox Mid-360", 56301, {1380}, &MakeLivoxMid360),
      Livox("livox_hap", "Livox HAP", 57000, {1380}, &MakeLivoxMid360),
      Livox("livox_avia", "Livox Avia, Horizon", 60001, {1362, 1278}, &MakeLivoxAvia),
      SpectrumScan(),
  };
  return protocols;
}

const LidarProtocol* FindLidarProtocol(const std::string& name) {
  for (const LidarProtocol& protocol : LidarProtocols()) {
    if (!name.empty() && (protocol.name == name || protocol.short_name == name)) return &protocol;
  }
  return nullptr;
}

std::string LidarProtocolNames() {
  std::string names;
  for (const LidarProtocol& protocol : LidarProtocols()) {
    names += (names.empty() ? "" : ", ") + protocol.name;
  }
  return names;
}

std::string WrongLidarText(const LidarProtocol& protocol,
                           const std::map<std::size_t, std::int64_t>& sizes) {
  const auto most = std::max_element(
      sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::string model = protocol.title.substr(protocol.title.find(' ') + 1);
  if (most == sizes.end()) return "no " + model + " packet: nothing was received";
  std::string senders;
  for (const LidarProtocol& other : LidarProtocols()) {
    const bool is_sender =
        std::count(other.packet_bytes.begin(), other.packet_bytes.end(), most->first) > 0;
    if (is_sender && &other != &protocol) senders += (senders.empty() ? "" : ", ") + other.name;
  }
  const std::string bytes = std::to_string(most->first) + " bytes";
  std::string text = "no " + model + " packet among " + std::to_string(most->second) + " of " +
                     bytes + ": another sensor?";
  if (protocol.packet_bytes.empty()) text += " Or is the calibration another unit's?";
  if (!senders.empty()) text += " " + bytes + " is what " + senders + " sends";
  return text;
}

}  // namespace voqcal
